/* Opening, reading and writing without ever waiting. */
#ifndef POSIX_IO_H
#define POSIX_IO_H

#include <stddef.h>

#include "brace_hal_posix.h"

/* What errno means for somebody who wanted to open something. */
int32_t io_status_of_errno(void);

/* Listens at "HOST:PORT", taken from after the "://" up to a '/' or the end. where (room BRACE_POSIX_WHERE):
 * the same with the port that was given. */
int32_t io_listen(const char *scheme, const char *place, int *listener, char *where);

/* The next client that waits, -1: none. */
int io_accept(int listener);

/* A pty in raw mode: our end, and its other end kept open so that clients may come and go. where: its path.
 */
int32_t io_pty(int *file, int *kept, char *where);

/* A serial device, "PATH[@BAUD]", raw, locked for ourselves. */
int32_t io_tty(const char *place, int *file, char *where);

/* 8 data bits, 1 stop bit. OK, E_RANGE: a rate that the system does not know, E_DEVICE. HAL statuses. */
int32_t io_tty_setup(int file, uint32_t baud, brace_parity_t parity);

/* Bytes read; 0: nothing yet; -1: the other end has gone. */
int32_t io_read(int file, uint8_t *bytes, uint32_t room);

/* Bytes taken; 0: no room; -1: the other end has gone. */
int32_t io_write(int file, const uint8_t *bytes, uint32_t count);

void io_close(int *file);

/* All of it or nothing. */
bool queue_put(brace_posix_queue_t *queue, const uint8_t *bytes, uint32_t count);

/* Writes what the file takes. false: the other end has gone. */
bool queue_flush(brace_posix_queue_t *queue, int file);

/* Copies a text, cut to the room. */
void io_copy(char *to, size_t room, const char *from);

#endif
