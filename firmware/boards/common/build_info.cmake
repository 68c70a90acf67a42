# cmake -DSOURCE=... -DOUT=... -DBRACE_VERSION=... -DBRACE_BUILD_TYPE=... [-DBRACE_SOURCE_HASH=...] -P build_info.cmake
# Runs with every build, and rewrites build_info.h only when its content changes. A release passes the hash, because it
# builds a copy of a commit.
if(BRACE_SOURCE_HASH)
    configure_file(${CMAKE_CURRENT_LIST_DIR}/build_info.h.in ${OUT}/build_info.h @ONLY)
    return()
endif()
execute_process(COMMAND git -C ${SOURCE} rev-parse --short=12 HEAD
    OUTPUT_VARIABLE BRACE_SOURCE_HASH OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE no_git)
if(no_git)
    set(BRACE_SOURCE_HASH "unknown")
else()
    execute_process(COMMAND git -C ${SOURCE} --no-optional-locks status --porcelain --untracked-files=no
        -- firmware hal CMakeLists.txt CMakePresets.json
        OUTPUT_VARIABLE changes ERROR_QUIET)
    if(changes)
        string(APPEND BRACE_SOURCE_HASH "-dirty")
    endif()
endif()
configure_file(${CMAKE_CURRENT_LIST_DIR}/build_info.h.in ${OUT}/build_info.h @ONLY)
