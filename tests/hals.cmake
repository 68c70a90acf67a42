# The hardware layers that any target can build; unit tests may stand them behind the application.
set(BRACE_TEST_HALS)
foreach(name IN ITEMS blank dynamixel fake selftest)
    if(TARGET brace_hal_${name})
        list(APPEND BRACE_TEST_HALS brace_hal_${name})
    endif()
endforeach()
