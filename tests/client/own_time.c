/* How long the program that links this has waited and computed, on stderr when it ends: "own time N ms". A wait counts
 * up to the time-out that was given to it. So a machine that lets the program stand does not count, and a program that
 * waits on, or again with each byte that comes, does. poll and select stand here in place of libc's: the client and
 * libmodbus wait by nothing else. */
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/select.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

static double waited_ms;

static double time_of(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

/* most_ms: below 0 without an end */
static void count_wait(double begin_ms, double most_ms)
{
    const double took_ms = time_of(CLOCK_MONOTONIC) - begin_ms;
    waited_ms += most_ms >= 0.0 && took_ms > most_ms ? most_ms : took_ms;
}

int poll(struct pollfd *places, nfds_t count, int timeout_ms)
{
    struct timespec most = {timeout_ms / 1000, timeout_ms % 1000 * 1000000L};
    const double begin_ms = time_of(CLOCK_MONOTONIC);
    const int found = (int)syscall(SYS_ppoll, places, count, timeout_ms < 0 ? NULL : &most, NULL, 0);
    count_wait(begin_ms, timeout_ms);
    return found;
}

int select(int count, fd_set *reads, fd_set *writes, fd_set *excepts, struct timeval *timeout)
{
    struct timespec most = {timeout != NULL ? timeout->tv_sec : 0, timeout != NULL ? timeout->tv_usec * 1000L : 0};
    const double begin_ms = time_of(CLOCK_MONOTONIC);
    const double most_ms = timeout != NULL ? (double)most.tv_sec * 1e3 + (double)most.tv_nsec * 1e-6 : -1.0;
    const int found = (int)syscall(SYS_pselect6, count, reads, writes, excepts, timeout != NULL ? &most : NULL, NULL);
    if (timeout != NULL) { /* Linux writes what is left */
        *timeout = (struct timeval){most.tv_sec, most.tv_nsec / 1000L};
    }
    count_wait(begin_ms, most_ms);
    return found;
}

static void write_own_time(void)
{
    fprintf(stderr, "own time %.0f ms\n", waited_ms + time_of(CLOCK_PROCESS_CPUTIME_ID));
}

__attribute__((constructor)) static void begin(void)
{
    atexit(write_own_time);
}
