/* Opening, reading and writing, never waiting. */
#ifndef POSIX_IO_H
#define POSIX_IO_H

#include <stddef.h>

#include "brace_hal_posix.h"

/* The BRACE_POSIX_E_... of errno after a failed open. */
int32_t io_status_of_errno(void);

/* Listens at "HOST:PORT", taken from after the "://" up to a '/' or the end. where (room BRACE_POSIX_WHERE): the same
 * with the port that the system gave. */
int32_t io_listen(const char *scheme, const char *place, int *listener, char *where);

/* The next client that waits; -1: no client waits. */
int io_accept(int listener);

/* Opens a pty in raw mode. Also keeps its other end open, so that clients may come and go. where: its path.
 */
int32_t io_pty(int *file, int *kept, char *where);

/* Opens a serial device, "PATH[@BAUD]", raw, and locks it for this process. */
int32_t io_tty(const char *place, int *file, char *where);

/* Sets 8 data bits, 1 stop bit. Returns a HAL status: OK, E_RANGE (a rate that the system does not know), E_DEVICE. */
int32_t io_tty_setup(int file, uint32_t baud, brace_parity_t parity);

/* Returns how many bytes it read; 0: none has come yet; -1: the other end has closed. */
int32_t io_read(int file, uint8_t *bytes, uint32_t room);

/* Returns how many bytes the file took; 0: there is no room; -1: the other end has closed. */
int32_t io_write(int file, const uint8_t *bytes, uint32_t count);

void io_close(int *file);

/* Queues all of the bytes, or none. */
bool queue_put(brace_posix_queue_t *queue, const uint8_t *bytes, uint32_t count);

/* Writes as much of the queue as the file takes. false: the other end has closed. */
bool queue_flush(brace_posix_queue_t *queue, int file);

/* Copies a text, and cuts it to the room. */
void io_copy(char *to, size_t room, const char *from);

#endif
