# What a program needs to start on the emulator's boards: start-up, memory, and printf by semihosting.
if(CMAKE_SYSTEM_PROCESSOR STREQUAL arm)
    target_sources(k PRIVATE ../bare_loop/cortex_m.c)
    target_link_options(k PRIVATE --specs=rdimon.specs
        -Wl,-u,_printf_float,-u,vectors,--section-start=.vectors=0)
else()
    target_compile_definitions(k PRIVATE PICOLIBC_DOUBLE_PRINTF_SCANF)
    target_link_options(k PRIVATE -DPICOLIBC_DOUBLE_PRINTF_SCANF --crt0=semihost --oslib=semihost
        -Wl,--defsym=__flash=0x80000000,--defsym=__flash_size=4M,--defsym=__ram=0x80400000,--defsym=__ram_size=1M)
endif()
