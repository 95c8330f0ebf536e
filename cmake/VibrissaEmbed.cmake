# vibrissa_embed(TARGET HEADER NAMESPACE NAME FILE [NAME FILE ...]): adds a generated source to TARGET that defines
# std::string_view NAME() of HEADER for the content of each FILE; the source is made again when a file changes.
#
# The file is its own script: cmake -DOUTPUT=... -DHEADER=... -DNAMESPACE=... -DPAIRS="NAME|FILE|..." -P VibrissaEmbed.cmake

if(CMAKE_SCRIPT_MODE_FILE)
  string(REPLACE "|" ";" pairs "${PAIRS}")
  file(WRITE ${OUTPUT} "#include \"${HEADER}\"\n\nnamespace ${NAMESPACE} {\n")
  while(pairs)
    list(POP_FRONT pairs name path)
    file(READ ${path} content)
    if(content MATCHES "\\)vibrissa_file\"")
      message(FATAL_ERROR "${path} contains the end mark of the string literal in which it is embedded")
    endif()
    file(APPEND ${OUTPUT} "\nstd::string_view ${name}() {\n  return R\"vibrissa_file(")
    file(APPEND ${OUTPUT} "${content}")
    file(APPEND ${OUTPUT} ")vibrissa_file\";\n}\n")
  endwhile()
  file(APPEND ${OUTPUT} "\n}  // namespace ${NAMESPACE}\n")
  return()
endif()

set(VIBRISSA_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

function(vibrissa_embed target header namespace)
  get_filename_component(stem ${header} NAME_WE)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${stem}.cc)
  set(files "")
  set(pairs ${ARGN})
  list(LENGTH pairs n)
  math(EXPR last "${n} - 1")
  foreach(i RANGE 1 ${last} 2)
    list(GET pairs ${i} path)
    if(NOT EXISTS ${path})
      message(FATAL_ERROR "${path} is missing: install the packages of packages.txt")
    endif()
    list(APPEND files ${path})
  endforeach()
  list(JOIN pairs "|" joined)
  add_custom_command(OUTPUT ${source}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${source} -DHEADER=${header} -DNAMESPACE=${namespace}
            "-DPAIRS=${joined}" -P ${VIBRISSA_EMBED_SCRIPT}
    DEPENDS ${files} ${VIBRISSA_EMBED_SCRIPT}
    COMMENT "Embedding ${stem}"
    VERBATIM)
  target_sources(${target} PRIVATE ${source})
endfunction()
