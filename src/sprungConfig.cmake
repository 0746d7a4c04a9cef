# What those who link an installed Sprung need besides it: its headers include Eigen alone, static libraries link what they use.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4 NO_MODULE)
if(NOT "@BUILD_SHARED_LIBS@" AND NOT "@SPRUNG_ONE_LIBRARY@")
  find_dependency(TBB)
  find_dependency(assimp)
  find_dependency(tinyobjloader)
  find_dependency(fcl)
endif()

include(${CMAKE_CURRENT_LIST_DIR}/sprungTargets.cmake)

# Programs name the folders that they use, also where one library has them all.
foreach(folder IN ITEMS @folders_of_one_library@)
  if(NOT TARGET sprung::${folder})
    add_library(sprung::${folder} ALIAS sprung::sprung)
  endif()
endforeach()
