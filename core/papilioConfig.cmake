include(CMakeFindDependencyMacro)
find_dependency(meshoptimizer)
include(${CMAKE_CURRENT_LIST_DIR}/papilioTargets.cmake)
