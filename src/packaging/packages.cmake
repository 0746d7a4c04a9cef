# The packages for Debian, by CPack: sprung, libsprung0.2 (its number is that of the library's name), libsprung-dev and python3-sprung.
if(NOT SPRUNG_ONE_LIBRARY)
  message(FATAL_ERROR "The packages have one shared library: set SPRUNG_ONE_LIBRARY too, as `cmake --preset package` does.")
endif()
if(NOT SPRUNG_VIEWER OR NOT SPRUNG_PYTHON)
  message(FATAL_ERROR "The packages have the viewer and the Python module, which cannot be built here, as said above. "
                      "`examples/install_packages.sh run view python package` installs what they need.")
endif()
foreach(program IN ITEMS dpkg-shlibdeps file readelf)
  find_program(SPRUNG_FOUND_${program} ${program})
  if(NOT SPRUNG_FOUND_${program})
    message(FATAL_ERROR "The packages need the program ${program}: `examples/install_packages.sh package` installs it.")
  endif()
endforeach()

set(folder ${PROJECT_BINARY_DIR}/packaging)
set(so_version ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program library development python)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SOURCE sprung)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "The Sprung developers <developers@sprung.invalid>" CACHE STRING "Who answers for the packages")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/src)

set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # each package has its own, the first line of its description
set(about "Sprung simulates ropes, cloths and elastic solids as networks of masses and
damped springs that collide with meshes, with each other and with themselves.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME sprung)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_COMPONENT_PROGRAM_DEPENDS library)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "blender, glmark2-data, gnuplot-nox | gnuplot, xdg-utils")
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "simulator of ropes, cloths and solids that collide with meshes
${about}

This package has the program, which simulates scenes in JSON, shows them live
in the browser and exports animations. The JSON schema, example scenes and an
add-on for Blender are in /usr/share/sprung.")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libsprung${so_version})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "simulator of ropes, cloths and solids (shared library)
${about}

This package has the library that programs share.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libsprung-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEVELOPMENT_DEPENDS library)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4)")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "cmake, pkg-config")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "simulator of ropes, cloths and solids (headers)
${about}

This package has the headers for C++20, and what CMake and pkg-config need to
find the library.")

math(EXPR next_python "${Python_VERSION_MINOR} + 1")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-sprung)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_COMPONENT_PYTHON_DEPENDS library)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.${Python_VERSION_MINOR}~), python3 (<< 3.${next_python}), python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "sprung")
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "simulator of ropes, cloths and solids (Python module)
${about}

This package has the Python module: scenes, simulators and their particles as
NumPy arrays.")

# Files that CPack does not write: those for dpkg's ldconfig and for programs that link the library, and bytecode for Python.
file(WRITE ${folder}/library/triggers "activate-noawait ldconfig\n")
file(WRITE ${folder}/library/shlibs "libsprung ${so_version} libsprung${so_version} (>= ${PROJECT_VERSION})\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${folder}/library/triggers ${folder}/library/shlibs)
file(WRITE ${folder}/python/postinst "#!/bin/sh\nset -e\nif command -v py3compile >/dev/null; then py3compile -p python3-sprung; fi\n")
file(WRITE ${folder}/python/prerm "#!/bin/sh\nset -e\nif command -v py3clean >/dev/null; then py3clean -p python3-sprung; fi\n")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${folder}/python/postinst ${folder}/python/prerm)

# Policy: each package has a copyright, with those of the libraries in the viewer's page, and a changelog. Its date is that of the version.
file(READ LICENSE licence)
file(READ ${SPRUNG_PAGE_FOLDER}/node_modules/three/LICENSE licence_of_three)
file(WRITE ${folder}/copyright "${licence}\n\nThe page of `sprung view` contains three.js:\n\n${licence_of_three}")
file(STRINGS CHANGELOG.md headings REGEX "^## ${PROJECT_VERSION} - [0-9-]+$")
string(REGEX REPLACE "^.* - " "" date "${headings}")
execute_process(COMMAND date --utc --rfc-email --date=${date} OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
file(WRITE ${folder}/changelog.Debian "sprung (${PROJECT_VERSION}-1) unstable; urgency=medium

  * Version ${PROJECT_VERSION}: CHANGELOG.md in the sources tells what is new.

 -- ${CPACK_DEBIAN_PACKAGE_MAINTAINER}  ${date}
")
execute_process(COMMAND gzip -9nf ${folder}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  install(FILES ${folder}/copyright ${folder}/changelog.Debian.gz COMPONENT ${component}
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
endforeach()
execute_process(COMMAND gzip -9nc CHANGELOG.md OUTPUT_FILE ${folder}/changelog.gz WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
                COMMAND_ERROR_IS_FATAL ANY)
# Who looks for examples in the folder of documents finds them too.
file(CREATE_LINK ../../sprung/examples ${folder}/examples SYMBOLIC)
install(FILES ${folder}/changelog.gz ${folder}/examples COMPONENT program DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/sprung)

include(CPack)
