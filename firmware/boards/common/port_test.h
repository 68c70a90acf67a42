/* The port's self-test on the console. It commands no joint, but no tick runs meanwhile; afterwards the board
 * restarts. */
#ifndef BRACE_BOARDS_PORT_TEST_H
#define BRACE_BOARDS_PORT_TEST_H

#include "brace/app.h"
#include "text.h"

typedef enum {
    PORT_TEST_PLAIN = 0,
    PORT_TEST_SLOT,  /* also erases and writes the parameter slot that is not in force */
    PORT_TEST_DRIVES /* also asks the drives for no offset and no bound of torque; the limb must hang free */
} port_test_t;

/* The slot that PORT_TEST_SLOT erases. */
uint32_t port_test_slot(const brace_app_t *app);

/* May it begin now? Returns NULL, or why not, in words. */
const char *port_test_obstacle(const brace_app_t *app, port_test_t kind);

/* Runs it, prints what it finds, and restarts the board. Call it only where there is no obstacle. */
void port_test_run(text_t *text, const brace_app_t *app, port_test_t kind);

#endif
