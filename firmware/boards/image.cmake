# brace_board_image(TARGET SOURCE...): an image for the emulated board of this build's core, with semihosting.
# BRACE_CORE_NAME comes from the toolchain file (firmware/boards/toolchain/).
set(BRACE_BOARDS_DIR ${CMAKE_CURRENT_LIST_DIR})

# The MPS2 board has either processor. Cortex-M0+ code runs on its Cortex-M3, with a fault on every unaligned access.
set(BRACE_MACHINE_m4f mps2-an386)
set(BRACE_MACHINE_m3 mps2-an385)
set(BRACE_MACHINE_m0plus mps2-an385)
set(BRACE_MACHINE ${BRACE_MACHINE_${BRACE_CORE_NAME}})

add_library(brace_board_startup OBJECT ${BRACE_BOARDS_DIR}/common/startup.c) # compiled once for all images
target_link_libraries(brace_board_startup PRIVATE brace_warnings)

function(brace_board_image target)
    add_executable(${target} ${ARGN} $<TARGET_OBJECTS:brace_board_startup>)
    set_target_properties(${target} PROPERTIES SUFFIX .elf
        LINK_DEPENDS "${BRACE_BOARDS_DIR}/common/sections.ld;${BRACE_BOARDS_DIR}/mps2/memory.ld")
    target_link_options(${target} PRIVATE -nostartfiles --specs=nano.specs --specs=rdimon.specs -u _printf_float
        -L${BRACE_BOARDS_DIR}/common -T${BRACE_BOARDS_DIR}/mps2/memory.ld)
endfunction()
