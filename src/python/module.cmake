# The package `sprung`: Python sources, and the extension module sprung._core. It lies ready to use in <build folder>/python.
set(python_package ${PROJECT_BINARY_DIR}/python/sprung)
file(GLOB python_sources CONFIGURE_DEPENDS python/*.cpp python/simulator/*.cpp)
if(SPRUNG_VIEWER)
  list(FILTER python_sources EXCLUDE REGEX "/no_show.cpp$")
else()
  list(FILTER python_sources EXCLUDE REGEX "/show.cpp$")
endif()
pybind11_add_module(sprung_python MODULE NO_EXTRAS ${python_sources})
target_link_libraries(sprung_python PRIVATE sprung_options sprung::sprung)
if(SPRUNG_VIEWER)
  target_link_libraries(sprung_python PRIVATE sprung::viewer)
endif()
target_compile_definitions(sprung_python PRIVATE SPRUNG_VERSION="${PROJECT_VERSION}")
set_target_properties(sprung_python PROPERTIES OUTPUT_NAME _core LIBRARY_OUTPUT_DIRECTORY ${python_package}
                                               INSTALL_RPATH "$ORIGIN/../../..")

file(GLOB python_files CONFIGURE_DEPENDS python/sprung/*.py python/sprung/*.pyi python/sprung/py.typed)
file(MAKE_DIRECTORY ${python_package})
foreach(file IN LISTS python_files)
  cmake_path(GET file FILENAME name)
  file(CREATE_LINK ${file} ${python_package}/${name} SYMBOLIC)
endforeach()

set(SPRUNG_PYTHON_FOLDER lib/python${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}/dist-packages
    CACHE STRING "Where the Python package is installed, below the prefix")
install(TARGETS sprung_python LIBRARY DESTINATION ${SPRUNG_PYTHON_FOLDER}/sprung)
install(FILES ${python_files} DESTINATION ${SPRUNG_PYTHON_FOLDER}/sprung)
