# Makes the zip of the Blender add-on, ZIP, of the files of this folder.
cmake_minimum_required(VERSION 3.25)
file(GLOB files RELATIVE ${CMAKE_CURRENT_LIST_DIR} ${CMAKE_CURRENT_LIST_DIR}/sprung/*.py ${CMAKE_CURRENT_LIST_DIR}/sprung/*.toml)
execute_process(COMMAND ${CMAKE_COMMAND} -E tar cf ${ZIP} --format=zip -- ${files}
                WORKING_DIRECTORY ${CMAKE_CURRENT_LIST_DIR} COMMAND_ERROR_IS_FATAL ANY)
