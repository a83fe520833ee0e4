include(CMakeFindDependencyMacro)
find_dependency(meshoptimizer)
find_dependency(Threads)
include(${CMAKE_CURRENT_LIST_DIR}/papilioTargets.cmake)
