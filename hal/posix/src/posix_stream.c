#include <fcntl.h>
#include <string.h>
#include <unistd.h>

#include "posix_door.h"
#include "posix_io.h"

int32_t brace_posix_stream_open(brace_posix_stream_t *stream, const char *url)
{
    *stream = (brace_posix_stream_t){.kind = BRACE_POSIX_STREAM_NONE, .file = -1, .kept = -1, .listener = -1};
    int32_t status = BRACE_POSIX_OK;
    if (strcmp(url, "none") == 0) {
        return status;
    }
    io_copy(stream->where, sizeof stream->where, url);
    if (strcmp(url, "stderr") == 0 || strncmp(url, "file:", 5) == 0) {
        stream->kind = BRACE_POSIX_STREAM_FILE;
        stream->file = url[0] == 's' ? fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0)
                                     : open(url + 5, O_WRONLY | O_CREAT | O_APPEND | O_NONBLOCK | O_CLOEXEC, 0666);
        status = stream->file >= 0 ? BRACE_POSIX_OK : io_status_of_errno();
    } else if (strcmp(url, "pty") == 0) {
        stream->kind = BRACE_POSIX_STREAM_PTY;
        status = io_pty(&stream->file, &stream->kept, stream->where);
    } else if (strncmp(url, "tcp://", 6) == 0) {
        stream->kind = BRACE_POSIX_STREAM_TCP;
        status = io_listen("tcp", url + 6, &stream->listener, stream->where);
    } else if (url[0] == '/') {
        stream->kind = BRACE_POSIX_STREAM_TTY;
        status = io_tty(url, &stream->file, stream->where);
    } else {
        status = BRACE_POSIX_E_URL;
    }
    if (status != BRACE_POSIX_OK) {
        stream->kind = BRACE_POSIX_STREAM_NONE;
    }
    return status;
}

void brace_posix_stream_close(brace_posix_stream_t *stream)
{
    io_close(&stream->file);
    io_close(&stream->kept);
    io_close(&stream->listener);
    stream->kind = BRACE_POSIX_STREAM_NONE;
}

void stream_poll(brace_posix_stream_t *stream)
{
    if (stream->kind != BRACE_POSIX_STREAM_TCP) {
        return;
    }
    int client = io_accept(stream->listener);
    if (client >= 0 && stream->file >= 0) {
        io_close(&client); /* a line has only one other end */
    } else if (client >= 0) {
        stream->file = client;
    }
}

int32_t stream_setup(brace_posix_stream_t *stream, uint32_t baud, brace_parity_t parity)
{
    if (stream->kind == BRACE_POSIX_STREAM_NONE) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    if (baud < 1200u || baud > 4000000u || parity > BRACE_PARITY_ODD) {
        return BRACE_HAL_E_RANGE;
    }
    return stream->kind == BRACE_POSIX_STREAM_TTY ? io_tty_setup(stream->file, baud, parity) : BRACE_HAL_OK;
}

static int32_t lost(brace_posix_stream_t *stream)
{
    if (stream->kind == BRACE_POSIX_STREAM_TCP) {
        io_close(&stream->file);
        return 0;
    }
    return stream->kind == BRACE_POSIX_STREAM_TTY ? BRACE_HAL_E_DEVICE : 0;
}

int32_t brace_posix_stream_write(brace_posix_stream_t *stream, const uint8_t *bytes, uint32_t count)
{
    if (stream->kind == BRACE_POSIX_STREAM_NONE) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    if (stream->file < 0) {
        return (int32_t)count; /* nobody listens: the bytes are lost, as on a real line */
    }
    const int32_t taken = io_write(stream->file, bytes, count);
    return taken >= 0 ? taken : lost(stream);
}

int32_t brace_posix_stream_read(brace_posix_stream_t *stream, uint8_t *bytes, uint32_t room)
{
    if (stream->kind == BRACE_POSIX_STREAM_NONE) {
        return BRACE_HAL_E_UNSUPPORTED;
    }
    if (stream->kind == BRACE_POSIX_STREAM_FILE || stream->file < 0) {
        return 0;
    }
    const int32_t count = io_read(stream->file, bytes, room);
    if (count >= 0 || stream->kind == BRACE_POSIX_STREAM_TTY) {
        return count >= 0 ? count : 0; /* a raw tty without bytes looks closed, but is not */
    }
    return lost(stream);
}
