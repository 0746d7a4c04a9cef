# What those who link an installed Sprung need besides it.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4 NO_MODULE)
find_dependency(TBB)
find_dependency(assimp)
find_dependency(tinyobjloader)
find_dependency(fcl)

include(${CMAKE_CURRENT_LIST_DIR}/sprungTargets.cmake)
