# One name for what systems call differently.
string(TOLOWER "${CMAKE_SYSTEM_PROCESSOR}" brace_processor)
string(REGEX REPLACE "^(amd64|x64)$" "x86_64" brace_processor "${brace_processor}")
string(REGEX REPLACE "^arm64$" "aarch64" brace_processor "${brace_processor}")
