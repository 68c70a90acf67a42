# The hardware layers that any target can build; unit tests may stand them behind the application.
set(BRACE_TEST_HALS)
foreach(name IN ITEMS blank dynamixel fake selftest)
    if(TARGET brace_hal_${name})
        list(APPEND BRACE_TEST_HALS brace_hal_${name})
    endif()
endforeach()

# The console of an image, judged without a board: tests/unit/bench/console_board.h stands in for the rest of it.
set(console ${PROJECT_SOURCE_DIR}/firmware/boards/common)
add_library(brace_test_console STATIC)
foreach(name IN ITEMS banner console crash_words key_entry port_test question stiffness_words text typed)
    target_sources(brace_test_console PRIVATE ${console}/${name}.c)
endforeach()
target_include_directories(brace_test_console PUBLIC ${console})
target_link_libraries(brace_test_console PUBLIC brace_hal brace_app brace_interface brace_hal_selftest
    PRIVATE brace_warnings)
list(PREPEND BRACE_TEST_HALS brace_test_console)
