# Installs Sprung into WORK_FOLDER, then configures, builds and runs PROGRAM in a project that finds it there.
# Needs BINARY_FOLDER, WORK_FOLDER, PROGRAM, GENERATOR, COMPILER, BUILD_TYPE and FLAGS.
file(REMOVE_RECURSE ${WORK_FOLDER})
set(installed ${WORK_FOLDER}/installed)
set(built ${WORK_FOLDER}/built)

function(run)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install ${BINARY_FOLDER} --prefix ${installed})
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${built} -G ${GENERATOR}
    -DCMAKE_PREFIX_PATH=${installed} -DPROGRAM=${PROGRAM}
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=${BUILD_TYPE} -DCMAKE_CXX_FLAGS=${FLAGS})
run(${CMAKE_COMMAND} --build ${built})
run(${built}/hello)
if(NOT output MATCHES "after 2 s the bob is at ")
  message(FATAL_ERROR "The consumer printed:\n${output}")
endif()

run(${installed}/bin/sprung --help)
file(GLOB shared RELATIVE ${installed}/share/sprung ${installed}/share/sprung/*)
if(NOT shared STREQUAL "scene.schema.json")
  message(FATAL_ERROR "share/sprung contains: ${shared}")
endif()
foreach(file share/sprung/scene.schema.json include/sprung/simulation/simulator.h)
  if(NOT EXISTS ${installed}/${file})
    message(FATAL_ERROR "${file} was not installed")
  endif()
endforeach()
