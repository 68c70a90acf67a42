/* Lets the user-mode kernel run on a processor whose floating-point state is larger than the kernel expects (AMX).
 *
 * Debian's user-mode kernel keeps 2,696 bytes of a process's extended state. The host's ptrace takes such a state only
 * in its whole size, and refuses every write of fewer bytes, so that no process of the guest ever starts. Here a write
 * is completed with what the process already has beyond those bytes. No program in the guest uses that part (AMX's
 * tiles). with_vcan builds this library and preloads it into the kernel. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <elf.h>
#include <stdarg.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/types.h>
#include <sys/uio.h>

typedef long ptrace_t(enum __ptrace_request request, ...);

#define STATE_MOST_BYTES 65536u

static long write_whole_state(ptrace_t *host, pid_t pid, void *kind, const struct iovec *given)
{
    static char state[STATE_MOST_BYTES]; /* the user-mode kernel has one thread that traces */
    struct iovec whole = {state, sizeof state};
    const long status = host(PTRACE_GETREGSET, pid, kind, &whole);
    if (status != 0) {
        return status;
    }
    memcpy(state, given->iov_base, given->iov_len < whole.iov_len ? given->iov_len : whole.iov_len);
    return host(PTRACE_SETREGSET, pid, kind, &whole);
}

long ptrace(enum __ptrace_request request, ...)
{
    static ptrace_t *host;
    va_list rest;
    va_start(rest, request);
    const pid_t pid = va_arg(rest, pid_t);
    void *const address = va_arg(rest, void *);
    void *const data = va_arg(rest, void *);
    va_end(rest);
    if (host == NULL) {
        host = (ptrace_t *)dlsym(RTLD_NEXT, "ptrace");
    }
    const int is_state = request == PTRACE_SETREGSET && address == (void *)(long)NT_X86_XSTATE;
    return is_state ? write_whole_state(host, pid, address, data) : host(request, pid, address, data);
}
