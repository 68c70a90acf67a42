# cmake -DELF=... -DSIZE=size -DMEMORY=memory.ld -DBOARD=... -P size_report.cmake
# Prints how much of its board an image uses, and writes it beside the image as <image>.size.json.
execute_process(COMMAND ${SIZE} -A -d ${ELF} OUTPUT_VARIABLE listing COMMAND_ERROR_IS_FATAL ANY)
file(READ ${MEMORY} memory)

function(region name out) # length of a region [byte]
    string(REGEX MATCH "${name} \\([a-z]+\\) : ORIGIN = [0-9a-fx]+, LENGTH = ([0-9]+)K" found "${memory}")
    math(EXPR bytes "${CMAKE_MATCH_1} * 1024")
    set(${out} ${bytes} PARENT_SCOPE)
endfunction()

function(sections out) # sum of the named sections [byte]
    set(sum 0)
    foreach(name IN LISTS ARGN)
        if("${listing}" MATCHES "\n\\.${name} +([0-9]+) ")
            math(EXPR sum "${sum} + ${CMAKE_MATCH_1}")
        endif()
    endforeach()
    set(${out} ${sum} PARENT_SCOPE)
endfunction()

region(FLASH flash_of)
region(RAM ram_of)
sections(flash vectors text data)
sections(ram stack kept data bss)
sections(stack stack)
get_filename_component(name ${ELF} NAME_WE)
get_filename_component(folder ${ELF} DIRECTORY)
math(EXPR flash_permille "1000 * ${flash} / ${flash_of}")
math(EXPR ram_permille "1000 * ${ram} / ${ram_of}")
file(WRITE ${folder}/${name}.size.json "{\"image\": \"${name}\", \"board\": \"${BOARD}\", "
    "\"flash_bytes\": ${flash}, \"flash_of_bytes\": ${flash_of}, "
    "\"ram_bytes\": ${ram}, \"ram_of_bytes\": ${ram_of}, \"stack_bytes\": ${stack}}\n")
message("${name}: flash ${flash} of ${flash_of} bytes (${flash_permille} permille), "
    "RAM ${ram} of ${ram_of} bytes (${ram_permille} permille), of which stack ${stack}")
