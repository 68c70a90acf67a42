/* How much a suite plays. An emulated board has to show that its arithmetic agrees; a host plays ten times as many. */
#ifndef TIMES_H
#define TIMES_H

#ifdef __arm__
enum { TIMES = 1, STRIDE = 11 /* it plays every eleventh entry of a list */ };
#else
enum { TIMES = 10, STRIDE = 1 };
#endif

#endif
