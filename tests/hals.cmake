# The hardware layers that any target can build; unit tests may stand them behind the application.
set(BRACE_TEST_HALS)
foreach(name IN ITEMS blank dynamixel fake selftest)
    if(TARGET brace_hal_${name})
        list(APPEND BRACE_TEST_HALS brace_hal_${name})
    endif()
endforeach()

# The parts of an image's console that are judged without a board.
set(console ${PROJECT_SOURCE_DIR}/firmware/boards/common)
add_library(brace_test_console STATIC ${console}/key_entry.c ${console}/text.c)
target_include_directories(brace_test_console PUBLIC ${console})
target_link_libraries(brace_test_console PUBLIC brace_hal PRIVATE brace_warnings)
list(APPEND BRACE_TEST_HALS brace_test_console)
