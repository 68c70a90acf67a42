# brace_controller_image(TARGET BOARD FOLDER MEMORY HAL SOURCE... [DEFINE NAME]...)
# An image to flash: <TARGET>.elf with .hex, .bin, .map and a size report beside it, in build/<preset>/images. It has no
# semihosting, no heap and no stdio, so the linker refuses a call of malloc or of a file function.
set(BRACE_IMAGES_DIR ${PROJECT_BINARY_DIR}/images)
set(BRACE_BUILD_INFO_DIR ${CMAKE_CURRENT_BINARY_DIR}/generated)

# Runs with every build, because the state of the source may have changed though no file of the image has.
add_custom_target(brace_build_info
    COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DOUT=${BRACE_BUILD_INFO_DIR}
        -DBRACE_VERSION=${PROJECT_VERSION} -DBRACE_BUILD_TYPE=${CMAKE_BUILD_TYPE}
        -DBRACE_SOURCE_HASH=${BRACE_SOURCE_HASH}
        -P ${CMAKE_CURRENT_LIST_DIR}/common/build_info.cmake
    BYPRODUCTS ${BRACE_BUILD_INFO_DIR}/build_info.h
    COMMENT "source hash")

set(BRACE_CONTROLLER_SOURCES main.c banner.c board_servos.c console.c crash_words.c fault.c image_info.c kept.c
    kept_nvm.c key_entry.c port_test.c question.c second_clock.c stack.c stand_in_joints.c start.c stiffness_words.c
    text.c typed.c)
list(TRANSFORM BRACE_CONTROLLER_SOURCES PREPEND ${CMAKE_CURRENT_LIST_DIR}/common/)

function(brace_controller_image target)
    cmake_parse_arguments(image "" "BOARD;MEMORY;HAL" "SOURCES;DEFINES" ${ARGN})
    set(boards ${CMAKE_CURRENT_FUNCTION_LIST_DIR})
    set(base ${BRACE_IMAGES_DIR}/${target})
    add_executable(${target} ${BRACE_CONTROLLER_SOURCES} ${image_SOURCES})
    add_dependencies(${target} brace_build_info)
    set_target_properties(${target} PROPERTIES SUFFIX .elf RUNTIME_OUTPUT_DIRECTORY ${BRACE_IMAGES_DIR}
        LINK_DEPENDS "${boards}/common/controller.ld;${boards}/${image_MEMORY}")
    target_compile_definitions(${target} PRIVATE BRACE_BOARD_NAME="${image_BOARD}" ${image_DEFINES})
    target_include_directories(${target} PRIVATE ${boards}/common ${BRACE_BUILD_INFO_DIR})
    # Start-up code clears memory itself, so the compiler must not make that a call into a library.
    target_compile_options(${target} PRIVATE -Os -ffreestanding -fno-tree-loop-distribute-patterns -fstack-usage)
    set_source_files_properties(${boards}/common/fault.c ${boards}/common/kept.c ${boards}/common/start.c
        PROPERTIES COMPILE_OPTIONS -mgeneral-regs-only)
    target_link_libraries(${target} PRIVATE ${image_HAL} brace_hal_dynamixel brace_hal_selftest brace_app
        brace_interface brace_core brace_warnings)
    target_link_options(${target} PRIVATE -nostartfiles --specs=nano.specs -Wl,-Map=${base}.map
        -L${boards}/common -T${boards}/${image_MEMORY})
    add_custom_command(TARGET ${target} POST_BUILD
        COMMAND ${CMAKE_OBJCOPY} -O ihex ${base}.elf ${base}.hex
        COMMAND ${CMAKE_OBJCOPY} -O binary ${base}.elf ${base}.bin
        COMMAND ${CMAKE_COMMAND} -DELF=${base}.elf -DSIZE=${CMAKE_SIZE} -DMEMORY=${boards}/${image_MEMORY}
            -DBOARD=${image_BOARD} -P ${boards}/common/size_report.cmake
        BYPRODUCTS ${base}.hex ${base}.bin ${base}.map ${base}.size.json)
    set_property(GLOBAL APPEND PROPERTY BRACE_CONTROLLER_IMAGES ${target})
endfunction()

# brace_controller_sums(): SHA256SUMS over all images. Call it after the last brace_controller_image.
function(brace_controller_sums)
    get_property(images GLOBAL PROPERTY BRACE_CONTROLLER_IMAGES)
    list(TRANSFORM images APPEND .elf OUTPUT_VARIABLE elves)
    list(TRANSFORM elves PREPEND ${BRACE_IMAGES_DIR}/)
    add_custom_command(OUTPUT ${BRACE_IMAGES_DIR}/SHA256SUMS
        COMMAND ${CMAKE_COMMAND} -DFOLDER=${BRACE_IMAGES_DIR} "-DIMAGES=${images}"
            -P ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/common/checksums.cmake
        DEPENDS ${images} ${elves} VERBATIM COMMENT "SHA256SUMS")
    add_custom_target(brace_images ALL DEPENDS ${BRACE_IMAGES_DIR}/SHA256SUMS)
endfunction()
