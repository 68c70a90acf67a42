# cmake -DFOLDER=... "-DIMAGES=a;b" -P checksums.cmake: SHA256SUMS as sha256sum --check reads it.
set(text "")
foreach(image IN LISTS IMAGES)
    foreach(kind IN ITEMS elf hex bin)
        file(SHA256 ${FOLDER}/${image}.${kind} sum)
        string(APPEND text "${sum}  ${image}.${kind}\n")
    endforeach()
endforeach()
file(WRITE ${FOLDER}/SHA256SUMS "${text}")
