# Suites that take long: ./dev test leaves them out, ./dev judges builds long_suites and runs them.
include_guard(GLOBAL)
add_custom_target(long_suites)

function(brace_takes_minutes test target)
    set_tests_properties(${test} PROPERTIES LABELS minutes)
    set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL TRUE)
    add_dependencies(long_suites ${target})
endfunction()
