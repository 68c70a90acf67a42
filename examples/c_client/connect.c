#include "connect.h"

#include <stdio.h>
#include <stdlib.h>

enum { OPEN_MS = 2500 };

brace_client_t *connect_limb(int argc, char **argv)
{
    char why[BRACE_CLIENT_WHY_ROOM];
    brace_client_t *limb;
    if (argc < 2) {
        fprintf(stderr, "usage: %s BUS [NODE]\n", argv[0]);
        exit(2);
    }
    const uint32_t node = argc > 2 ? (uint32_t)atoi(argv[2]) : 0;
    const brace_client_status_t status = brace_client_open(argv[1], node, 0, OPEN_MS, &limb, why, sizeof why);
    if (status != BRACE_CLIENT_OK) {
        fprintf(stderr, "%s\n", why);
        exit(brace_client_exit_code(status));
    }
    return limb;
}

int disconnect_limb(brace_client_t *limb, brace_client_status_t status)
{
    if (status != BRACE_CLIENT_OK) {
        fprintf(stderr, "%s\n", brace_client_why(limb));
    }
    brace_client_close(limb);
    return brace_client_exit_code(status);
}
