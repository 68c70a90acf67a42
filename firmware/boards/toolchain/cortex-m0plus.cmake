# Cortex-M0+: no FPU, no long multiply, no divide, no unaligned access.
set(BRACE_CORE_NAME m0plus)
set(BRACE_CPU_FLAGS "-mcpu=cortex-m0plus -mthumb")
include(${CMAKE_CURRENT_LIST_DIR}/arm-none-eabi.cmake)
