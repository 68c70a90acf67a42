# A comment that begins a line describes what follows; one behind a declaration describes that. An @ is an @. The
# comment at a header's beginning describes all of it.
/^[[:space:]]*#/!s/@/\\@/g
1s#^/\*([^*])#/** \\file\n\1#
s#^([[:space:]]*)/\*([^*])#\1/**\2#
s#([;,{])([[:space:]]*)/\*([^*])#\1\2/**<\3#
