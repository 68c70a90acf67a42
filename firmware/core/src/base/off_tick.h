/* What no tick calls is kept small instead of fast: one copy of it, and size before speed. */
#ifndef BRACE_OFF_TICK_H
#define BRACE_OFF_TICK_H

#if defined(__GNUC__) && !defined(__clang__)
/* Scheduling before registers are allotted costs moves. */
#define BRACE_OFF_TICK __attribute__((cold, noinline, optimize("no-schedule-insns")))
#elif defined(__GNUC__)
#define BRACE_OFF_TICK __attribute__((cold, noinline))
#else
#define BRACE_OFF_TICK
#endif

/* Its loops stay loops: a call of the C library's memset would be longer. */
#if defined(__GNUC__) && !defined(__clang__)
#define BRACE_LOOPS_STAY __attribute__((optimize("no-tree-loop-distribute-patterns")))
#else
#define BRACE_LOOPS_STAY
#endif

#endif
