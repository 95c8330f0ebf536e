# What is installed: the program with its manual, completion, case files and Python package
# (component "program"), and the signal half as a C++ library for find_package(vibrissa)
# (component "library": headers that need no deal.II). `cpack` makes a Debian package of each.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(VIBRISSA_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/vibrissa)
foreach(room signals separation diagnosis)
  install(TARGETS vibrissa_${room} EXPORT vibrissa COMPONENT library
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  set_target_properties(vibrissa_${room} PROPERTIES EXPORT_NAME ${room})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${room} COMPONENT library
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vibrissa FILES_MATCHING PATTERN "*.h")
endforeach()
# The alignment of Eigen matrices depends on the SIMD registers of the processor: programs that link the
# library must be compiled for the same registers. The preset "package" builds for any processor.
if(VIBRISSA_NATIVE)
  target_compile_options(vibrissa_signals INTERFACE $<INSTALL_INTERFACE:-march=native>)
endif()
install(EXPORT vibrissa NAMESPACE vibrissa:: COMPONENT library
        DESTINATION ${VIBRISSA_PACKAGE_DIR} FILE vibrissaTargets.cmake)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/vibrissaConfig.cmake.in
  ${PROJECT_BINARY_DIR}/vibrissaConfig.cmake INSTALL_DESTINATION ${VIBRISSA_PACKAGE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/vibrissaConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/vibrissaConfig.cmake
              ${PROJECT_BINARY_DIR}/vibrissaConfigVersion.cmake
        COMPONENT library DESTINATION ${VIBRISSA_PACKAGE_DIR})

# Each package contains its licence and the copyright file that the Debian policy requires.
function(vibrissa_install_licence component folder)
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE COMPONENT ${component} DESTINATION ${folder})
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/debian_copyright COMPONENT ${component}
          DESTINATION ${folder} RENAME copyright)
endfunction()
vibrissa_install_licence(library ${CMAKE_INSTALL_DATADIR}/doc/libvibrissa-dev)

if(VIBRISSA_SOLID)
  vibrissa_install_licence(program ${CMAKE_INSTALL_DOCDIR})
  install(TARGETS vibrissa COMPONENT program DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(TARGETS vibrissa-solid generate_trial observe_trial COMPONENT program
          DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/vibrissa)
  install(TARGETS python_core python_solid COMPONENT program
          DESTINATION lib/python3/dist-packages/vibrissa)
  install(FILES ${PROJECT_SOURCE_DIR}/python/vibrissa/__init__.py
                ${PROJECT_SOURCE_DIR}/python/vibrissa/__init__.pyi
                ${PROJECT_SOURCE_DIR}/python/vibrissa/py.typed
          COMPONENT program DESTINATION lib/python3/dist-packages/vibrissa)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/cases COMPONENT program
          DESTINATION ${CMAKE_INSTALL_DATADIR}/vibrissa)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs COMPONENT program
          DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN "*.md" PATTERN "*.png")
  install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md
                ${PROJECT_SOURCE_DIR}/CONTRIBUTING.md
          COMPONENT program DESTINATION ${CMAKE_INSTALL_DOCDIR})
  # The program prints its own manual and completion.
  foreach(text "manual man/man1/vibrissa.1" "completion bash-completion/completions/vibrissa")
    string(REPLACE " " ";" text ${text})
    list(GET text 0 command)
    list(GET text 1 file)
    install(CODE "
      set(file \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/${file}\")
      get_filename_component(folder \"\${file}\" DIRECTORY)
      file(MAKE_DIRECTORY \"\${folder}\")
      execute_process(COMMAND ${PROJECT_BINARY_DIR}/vibrissa ${command}
                      OUTPUT_FILE \"\${file}\" COMMAND_ERROR_IS_FATAL ANY)"
      COMPONENT program)
  endforeach()
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME vibrissa)
set(CPACK_PACKAGE_CONTACT "The makers of Vibrissa <vibrissa@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program library)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME vibrissa)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libopenblas0-serial, fonts-dejavu-core")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "xvfb, xauth, openmpi-bin, python3-numpy")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
    "Finds why a whisker sensor on the bench differs from its simulation")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libvibrissa-dev)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS
    "libeigen3-dev, nlohmann-json3-dev, libfftw3-dev, libsndfile1-dev, libmatio-dev, libhdf5-dev, libudunits2-dev, libssl-dev, pkg-config")
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION
    "Identification, separation and diagnosis of whisker sensors as a C++ library")
include(CPack)
