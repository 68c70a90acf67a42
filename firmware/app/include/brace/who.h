/* Who asks for something that moves the limb or is written, and how the wires bring the proof that it may. */
#ifndef BRACE_WHO_H
#define BRACE_WHO_H

#include <stdbool.h>
#include <stdint.h>

#include "brace/k_question.h"

/* A master of one port. */
typedef struct {
    brace_asker_t port;
    uint32_t master; /* CAN: the upper four bits of the token; Modbus TCP: the connection's number; else 0 */
} brace_who_t;

enum { BRACE_SEALS_MOST = 8 };

/* The check of a command. Several may have come for one counter, because whoever can send on a bus can send seals, too:
 * the command is let in if one of them fits. */
typedef struct brace_seal {
    bool is_there;
    uint32_t counter; /* its number, or the low bits of it */
    uint32_t counter_bits; /* so many of them have come [8, 32] */
    uint32_t mac; /* SipHash-2-4 over challenge, whole counter, kind and the command's bytes: low 32 bits */
    const struct brace_seal *next; /* another one with the same counter, at most BRACE_SEALS_MOST of them; null: none */
} brace_seal_t;

/* A sign of life: its sender has lately heard the controller. */
typedef struct {
    uint32_t heard; /* a number that the controller has sent, or the low bits of it */
    uint32_t heard_bits; /* so many of them have come [16, 32] */
    uint32_t check; /* on a guarded board: SipHash-2-4 over challenge, whole number and kind: low 32 bits */
} brace_sign_t;

#endif
