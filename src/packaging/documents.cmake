# Files beside the program and the library: man page, completion, examples with their meshes, and what pkg-config reads.
set(data_folder ${CMAKE_INSTALL_DATADIR}/sprung)

# The program writes its man page, so it must run here.
if(NOT SPRUNG_SANITIZE AND NOT CMAKE_CROSSCOMPILING)
  set(man_page ${CMAKE_CURRENT_BINARY_DIR}/sprung.1.gz)
  add_custom_command(OUTPUT ${man_page} COMMAND ${CMAKE_CURRENT_LIST_DIR}/man_page.sh $<TARGET_FILE:sprung> ${man_page}
                     DEPENDS sprung ${CMAKE_CURRENT_LIST_DIR}/man_page.sh ${CMAKE_CURRENT_LIST_DIR}/man_page.awk VERBATIM)
  add_custom_target(sprung_man_page ALL DEPENDS ${man_page})
  install(FILES ${man_page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
endif()

install(FILES packaging/completion.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME sprung COMPONENT program)

file(GLOB scenes CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/examples/*.json)
install(FILES ${scenes} DESTINATION ${data_folder}/examples COMPONENT program)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples/lessons DESTINATION ${data_folder}/examples COMPONENT program)
file(GLOB programs CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/examples/*.cpp)
install(FILES ${programs} DESTINATION ${data_folder}/examples COMPONENT development)
file(GLOB meshes CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/meshes/*.obj ${PROJECT_SOURCE_DIR}/meshes/*.off ${PROJECT_SOURCE_DIR}/meshes/*.ply
     ${PROJECT_SOURCE_DIR}/meshes/*.stl ${PROJECT_SOURCE_DIR}/meshes/*.gltf)
install(FILES ${meshes} DESTINATION ${data_folder}/meshes COMPONENT program)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/meshes/waves DESTINATION ${data_folder}/meshes COMPONENT program)
if(SPRUNG_PYTHON)
  file(GLOB programs CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/examples/python/*.py ${PROJECT_SOURCE_DIR}/examples/python/*.ipynb)
  install(FILES ${programs} DESTINATION ${data_folder}/examples/python COMPONENT python)
endif()

# pkg-config is for the one library: static ones would ask programs for all that Sprung links.
if(SPRUNG_ONE_LIBRARY)
  configure_file(packaging/sprung.pc.in sprung.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/sprung.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
endif()
