/* The hardware and the limb of the tick's bench: a door whose work is not counted (all of it lies in
 * world.c, one stretch of code), and dice that decide what happens. */
#ifndef TICK_WORLD_H
#define TICK_WORLD_H

#include "brace/app.h"

typedef struct {
    uint64_t state;
} dice_t;

uint32_t dice_below(dice_t *dice, uint32_t n);
float dice_between(dice_t *dice, float low, float high);
bool dice_in(dice_t *dice, uint32_t n); /* once in n */

/* How the world of an episode behaves. */
typedef struct {
    bool cooperative;    /* joints follow commands, the contact holds: take-ups and tests succeed */
    uint32_t bad_in;     /* a bad sample once in so many; 0: never */
    bool restless;       /* postures jump */
    bool drives_fail;    /* commands are refused now and then */
    bool slcan;          /* CAN comes as text over a serial port too, and most requests do */
    bool flooded;        /* every port is asked something in every tick, or as often as its line allows */
    bool coxa;           /* the limb has a coxa joint: it is a limb in space */
    float gap_rad[BRACE_LINK_COUNT];
    float spring_n_mm_per_rad;
} world_manner_t;

extern brace_hal_t world_door;
extern uint32_t world_now_us;

/* A new episode. */
void world_begin(dice_t *dice, const world_manner_t *manner);

/* Before a tick: samples, force, frames and temperatures of this tick. */
void world_step(dice_t *dice);

/* A request to a node comes over CAN, among whatever else does. */
void world_asks(uint32_t node_id, const uint8_t data[8]);

/* Forgets what is stored. */
void world_erase(void);

#endif
