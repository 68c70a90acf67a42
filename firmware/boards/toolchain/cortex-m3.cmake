# Cortex-M3: no FPU, 32 x 32 -> 64 bit multiply and divide in hardware.
set(BRACE_CORE_NAME m3)
set(BRACE_CPU_FLAGS "-mcpu=cortex-m3 -mthumb")
include(${CMAKE_CURRENT_LIST_DIR}/arm-none-eabi.cmake)
