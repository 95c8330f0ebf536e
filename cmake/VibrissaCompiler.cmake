# Language level, warnings, optimisation, sanitizers, fast linker and compiler cache.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")
set(CMAKE_CXX_FLAGS_DEBUG "-O1 -g")
# A report needs lines and names of functions; debug information on variables would double the build time.
set(CMAKE_CXX_FLAGS_SANITIZE
    "-O1 -g1 -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize-recover=undefined")
set(CMAKE_EXE_LINKER_FLAGS_SANITIZE "-fsanitize=address,undefined")
set(CMAKE_CXX_FLAGS_THREADS "-O1 -g1 -fsanitize=thread")
set(CMAKE_EXE_LINKER_FLAGS_THREADS "-fsanitize=thread")

add_compile_options(-Wall -Wextra)
if(VIBRISSA_WERROR)
  add_compile_options(-Werror)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # GCC 12 wrongly warns of an overlap or overflow in "text" + string after much inlining (GCC bugs 105329,
  # 105651), depending on the target processor: these warnings are not errors.
  foreach(warning restrict stringop-overflow stringop-overread array-bounds)
    add_compile_options(-Wno-error=${warning})
  endforeach()
  # With sanitizers it also wrongly warns of uninitialised values in <regex> and <functional> of the
  # standard library (GCC bug 105562); the debug preset keeps this warning.
  add_compile_options($<$<CONFIG:Sanitize,Threads>:-Wno-error=maybe-uninitialized>)
endif()
if(VIBRISSA_NATIVE)
  add_compile_options(-march=native)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # GCC 12 warns inside its own AVX-512 intrinsics (GCC bug 105593). The debug and sanitize presets
    # build without -march=native and keep both warnings.
    add_compile_options(-Wno-maybe-uninitialized -Wno-uninitialized)
  endif()
endif()

if(VIBRISSA_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "VIBRISSA_FUZZ needs Clang: add -DCMAKE_CXX_COMPILER=clang++-14")
  endif()
  set(VIBRISSA_FUZZ_FLAGS -g -fno-omit-frame-pointer -fsanitize=fuzzer-no-link,address,undefined
                          -fno-sanitize-recover=undefined)
  add_compile_options(${VIBRISSA_FUZZ_FLAGS} -UNDEBUG)
  add_link_options(${VIBRISSA_FUZZ_FLAGS})
endif()

find_program(VIBRISSA_CCACHE ccache)
if(VIBRISSA_CCACHE)
  # ccache uses precompiled headers only with these options.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
      CCACHE_SLOPPINESS=pch_defines,time_macros ${VIBRISSA_CCACHE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    add_compile_options(-fpch-preprocess)
  endif()
endif()
find_program(VIBRISSA_LLD ld.lld)
if(VIBRISSA_LLD)
  add_link_options(-fuse-ld=lld)
endif()
