/* What this firmware calls itself on the wire; the project's version (CMakeLists.txt). */
#ifndef BRACE_APP_VERSION_H
#define BRACE_APP_VERSION_H

#define BRACE_FIRMWARE_MAJOR 0u
#define BRACE_FIRMWARE_MINOR 1u
#define BRACE_FIRMWARE_PATCH 0u
#define BRACE_FIRMWARE_VERSION (BRACE_FIRMWARE_MAJOR << 16 | BRACE_FIRMWARE_MINOR << 8 | BRACE_FIRMWARE_PATCH)

#endif
