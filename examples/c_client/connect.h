/* What the examples share: they are called with BUS [NODE ...] and say why something failed. */
#ifndef CONNECT_H
#define CONNECT_H

#include <brace/client.h>

/* The controller at BUS; NODE is 0 unless given: the first that is heard. When no controller
 * answers, the program ends with the exit code that the brace command has for that. */
brace_client_t *connect_limb(int argc, char **argv);

/* Prints why, if a call has failed, and closes the client.
 * returns the exit code of the brace command */
int disconnect_limb(brace_client_t *limb, brace_client_status_t status);

#endif
