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
if(NOT shared STREQUAL "examples;meshes;scene.schema.json;sprung_blender.zip")
  message(FATAL_ERROR "share/sprung contains: ${shared}")
endif()
execute_process(COMMAND ${CMAKE_COMMAND} -E tar tf ${installed}/share/sprung/sprung_blender.zip OUTPUT_VARIABLE addon)
foreach(file sprung/__init__.py sprung/job.py sprung/blender_manifest.toml)
  if(NOT addon MATCHES ${file})
    message(FATAL_ERROR "sprung_blender.zip contains: ${addon}")
  endif()
endforeach()
# Usage error: the line that lists them.
execute_process(COMMAND ${installed}/bin/sprung view --lesson none ERROR_VARIABLE listed RESULT_VARIABLE code)
if(NOT listed MATCHES "choose from 1_mass_on_a_spring, .*, 6_limit_or_stiff_springs" AND NOT listed MATCHES "without the viewer")
  message(FATAL_ERROR "The installed program lists no lessons:\n${listed}")
endif()
run(${installed}/bin/sprung run ${installed}/share/sprung/examples/rope_over_torus.json --frames 1 --out ${WORK_FOLDER}/rope)
foreach(file share/sprung/scene.schema.json include/sprung/simulation/simulator.h share/bash-completion/completions/sprung
        share/sprung/examples/hello.cpp share/sprung/examples/lessons/3_damping.txt share/sprung/meshes/waves/waves.1.obj)
  if(NOT EXISTS ${installed}/${file})
    message(FATAL_ERROR "${file} was not installed")
  endif()
endforeach()
if(NOT FLAGS AND NOT EXISTS ${installed}/share/man/man1/sprung.1.gz) # an instrumented program writes no man page
  message(FATAL_ERROR "The man page was not installed")
endif()
