# brace_part(PART TARGETS TARGET... [HEADERS FOLDER...] [PRIVATE_HEADERS FOLDER] [NEEDS PART])
# Makes the targets known as brace::<name> and says how they are installed: as a component of find_package(brace), and
# for pkg-config as brace-<part>. A target's name without "brace_" is its name in both. HEADERS are folders whose *.h
# go to include/. PRIVATE_HEADERS go to include/brace-<part>, because headers of theirs show struct members that users own.
# NEEDS names the part that this one links.
include_guard(GLOBAL)
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
include(${CMAKE_CURRENT_LIST_DIR}/version.cmake)

# Somebody else's project that takes Brace in installs what it likes to install.
set(install_by_default OFF)
if(PROJECT_IS_TOP_LEVEL AND PROJECT_NAME MATCHES "^brace")
    set(install_by_default ON)
endif()
option(BRACE_INSTALL "Install rules for Brace's libraries" ${install_by_default})
set(BRACE_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/brace)
set(BRACE_PACKAGE_FILES ${CMAKE_CURRENT_LIST_DIR})

function(brace_part part)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "PRIVATE_HEADERS;NEEDS" "TARGETS;HEADERS")
    foreach(target IN LISTS arg_TARGETS)
        string(REGEX REPLACE "^brace_" "" name ${target})
        add_library(brace::${name} ALIAS ${target})
        set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
    endforeach()
    if(NOT BRACE_INSTALL)
        return()
    endif()
    install(TARGETS ${arg_TARGETS} EXPORT brace_${part} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${part}
        INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
    install(EXPORT brace_${part} NAMESPACE brace:: FILE brace-${part}-targets.cmake DESTINATION ${BRACE_PACKAGE_DIR}
        COMPONENT ${part})
    foreach(folder IN LISTS arg_HEADERS)
        install(DIRECTORY ${folder}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT ${part}
            FILES_MATCHING PATTERN "*.h" PATTERN "src" EXCLUDE)
    endforeach()
    set(cflags "")
    if(arg_PRIVATE_HEADERS)
        install(DIRECTORY ${arg_PRIVATE_HEADERS}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/brace-${part}
            COMPONENT ${part} FILES_MATCHING PATTERN "*.h")
        set(cflags " -I\${includedir}/brace-${part}")
    endif()
    write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/brace-config-version.cmake VERSION ${BRACE_VERSION}
        COMPATIBILITY SameMinorVersion)
    # It compares the sizes of pointers. Two processors of 64 bits are told apart by their names.
    file(READ ${BRACE_PACKAGE_FILES}/processor.cmake of_the_user)
    include(${BRACE_PACKAGE_FILES}/processor.cmake)
    file(APPEND ${CMAKE_CURRENT_BINARY_DIR}/brace-config-version.cmake "
${of_the_user}
if(\"\${brace_processor} ${brace_processor}\" MATCHES \"^(x86_64 aarch64|aarch64 x86_64)$\")
    set(PACKAGE_VERSION \"\${PACKAGE_VERSION} (${brace_processor})\")
    set(PACKAGE_VERSION_UNSUITABLE TRUE)
endif()
")
    install(FILES ${BRACE_PACKAGE_FILES}/brace-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/brace-config-version.cmake
        DESTINATION ${BRACE_PACKAGE_DIR} COMPONENT ${part})
    brace_pkg_config(${part} "${arg_TARGETS}" "${cflags}" "${arg_NEEDS}")
endfunction()

# brace-<part>.pc. Its folder says where the rest is, so that an installed tree may be moved.
function(brace_pkg_config part targets cflags needs)
    file(RELATIVE_PATH up /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
    set(libraries "")
    foreach(target IN LISTS targets)
        get_target_property(type ${target} TYPE)
        if(type STREQUAL STATIC_LIBRARY)
            string(APPEND libraries " -l${target}")
        endif()
    endforeach()
    set(requires "")
    if(needs)
        set(requires "Requires: brace-${needs} = ${BRACE_VERSION}\n")
    endif()
    get_property(more GLOBAL PROPERTY BRACE_PC_${part})
    file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/brace-${part}.pc "prefix=\${pcfiledir}/${up}
libdir=\${prefix}/${CMAKE_INSTALL_LIBDIR}
includedir=\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}

Name: brace-${part}
Description: stiffness at the tip of a climbing robot's limb, part ${part}
Version: ${BRACE_VERSION}
License: Apache-2.0
${requires}Cflags: -I\${includedir}${cflags}
Libs: -L\${libdir}${libraries} -lm
${more}")
    install(FILES ${CMAKE_CURRENT_BINARY_DIR}/brace-${part}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
        COMPONENT ${part})
endfunction()
