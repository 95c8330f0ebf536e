# vibrissa_revision(TARGET): adds a generated source to TARGET that defines program_revision() and
# program_version() of signals/base/revision.h. Each build asks git again, which takes a few milliseconds;
# the source changes, and is compiled, only when the answer changes.
#
# The file is its own script: cmake -DROOT=... -DVERSION=... -DOUTPUT=... -P VibrissaRevision.cmake

if(CMAKE_SCRIPT_MODE_FILE)
  set(revision "unknown")
  find_program(GIT git)
  if(GIT)
    execute_process(COMMAND ${GIT} rev-parse --show-toplevel WORKING_DIRECTORY ${ROOT}
                    OUTPUT_VARIABLE top ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
    # Sources without their own repository, unpacked inside another repository, have no revision.
    if(top STREQUAL ROOT)
      execute_process(COMMAND ${GIT} describe --always --dirty --abbrev=12 WORKING_DIRECTORY ${ROOT}
                      OUTPUT_VARIABLE described RESULT_VARIABLE failed ERROR_QUIET
                      OUTPUT_STRIP_TRAILING_WHITESPACE)
      if(NOT failed)
        set(revision "${described}")
      endif()
    endif()
  endif()
  set(text "#include \"signals/base/revision.h\"\n
namespace vibrissa::signals {\n
const char* program_revision() { return \"${revision}\"; }
const char* program_version() { return \"${VERSION}\"; }\n
}  // namespace vibrissa::signals\n")
  set(old "")
  if(EXISTS ${OUTPUT})
    file(READ ${OUTPUT} old)
  endif()
  if(NOT text STREQUAL old)
    file(WRITE ${OUTPUT} "${text}")
  endif()
  return()
endif()

set(VIBRISSA_REVISION_SCRIPT ${CMAKE_CURRENT_LIST_FILE})
get_filename_component(VIBRISSA_REVISION_ROOT "${CMAKE_CURRENT_LIST_DIR}/.." REALPATH)

function(vibrissa_revision target)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/revision.cc)
  set(version "${CMAKE_PROJECT_VERSION}")
  if(NOT version)
    set(version "unknown")
  endif()
  add_custom_target(${target}_revision
    COMMAND ${CMAKE_COMMAND} -DROOT=${VIBRISSA_REVISION_ROOT} -DVERSION=${version}
            -DOUTPUT=${source} -P ${VIBRISSA_REVISION_SCRIPT}
    BYPRODUCTS ${source}
    COMMENT "Asking git for the revision")
  target_sources(${target} PRIVATE ${source})
  add_dependencies(${target} ${target}_revision)
endfunction()
