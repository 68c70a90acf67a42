# For a robot's computer with a 64-bit ARM (Raspberry Pi, Jetson), by Debian's gcc-aarch64-linux-gnu on another machine:
#   cmake -B build/aarch64 -DCMAKE_TOOLCHAIN_FILE=tools/client/cmake/aarch64-linux-gnu.cmake
# Where qemu-user-static is installed, what was built runs too: qemu-aarch64-static -L /usr/aarch64-linux-gnu PROGRAM
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)

set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
find_program(BRACE_QEMU_AARCH64 NAMES qemu-aarch64-static qemu-aarch64)
if(BRACE_QEMU_AARCH64)
    set(CMAKE_CROSSCOMPILING_EMULATOR ${BRACE_QEMU_AARCH64} -L /usr/aarch64-linux-gnu)
endif()

# Debian keeps the libraries of each architecture apart (apt-get install libmodbus-dev:arm64), headers in /usr/include.
# This machine's own pkg-config files name this machine's libraries.
if(NOT DEFINED ENV{PKG_CONFIG_LIBDIR})
    set(ENV{PKG_CONFIG_LIBDIR} /usr/lib/aarch64-linux-gnu/pkgconfig:/usr/aarch64-linux-gnu/lib/pkgconfig)
endif()
