/* The controller's memory, for whoever places a brace_app_t without a heap. Nothing in it is for others. */
#ifndef BRACE_APP_MEMORY_H
#define BRACE_APP_MEMORY_H

#include "controller.h"
#include "wire/wires.h"

struct brace_app {
    controller_t controller; /* the first: src/controller.h */
    wires_t wires;
};

#endif
