/* Simulated servos on one half-duplex line, with the registers and the answers of Dynamixel firmware (Protocol 2.0).
 *
 * They share no code with the driver in hal/dynamixel. The makers' own SDK is their judge (tests/servo). Time is given
 * with every call, in nanoseconds; a byte takes ten bits at the line's baud rate. The caller gives the bytes of the
 * master and takes those of the servos, and says where each servo's shaft is.
 *
 * What the firmware has: ping, read, write, reg write and action, reboot, sync read, fast sync read, sync write; status
 * return level, return delay, errors by number, alert bit, access and range of each register, registers that a reboot
 * sets back, half a second without an answer after a reboot. What it does not have: bulk read and write, factory reset,
 * indirect addresses, profiles, the bus watchdog.
 */
#ifndef BRACE_SERVOS_H
#define BRACE_SERVOS_H

#include <stdint.h>

typedef struct brace_servos brace_servos_t;

/* baud: of the line. seed: of the damage. null: no memory */
brace_servos_t *brace_servos_create(uint32_t baud, uint64_t seed);
void brace_servos_destroy(brace_servos_t *servos);

/* Adds a servo as it comes from its box, but for its id [0, 252], its operating mode 5 and a return delay of 0. Returns
 * its index, or -1: the id is taken. Each servo speaks at the line's baud rate. */
int32_t brace_servos_add(brace_servos_t *servos, uint8_t id, uint16_t model);

/* The master sends: its first byte leaves at at_ns. */
void brace_servos_hear(brace_servos_t *servos, uint64_t at_ns, const uint8_t *bytes, uint32_t count);

/* Bytes of the servos that have come whole by now_ns. */
uint32_t brace_servos_give(brace_servos_t *servos, uint64_t now_ns, uint8_t *bytes, uint32_t room);

/* Registers, whatever their access; count 1, 2 or 4. */
int32_t brace_servos_peek(const brace_servos_t *servos, int32_t servo, uint16_t address, uint32_t count);
void brace_servos_poke(brace_servos_t *servos, int32_t servo, uint16_t address, uint32_t count, int32_t value);

/* Where the shaft is, and what drives it [rad from the encoder's 0, rad/s, A, degC]. */
void brace_servos_shaft(brace_servos_t *servos, int32_t servo, double turned_rad, double speed_rad_per_s,
                        double current_a, double temp_degc);

/* What the servo commands its motor: goal [rad from the encoder's 0] and greatest current [A]. Returns 0 while its
 * torque is off. */
int32_t brace_servos_goal(const brace_servos_t *servos, int32_t servo, double *goal_rad, double *current_a);

/* Its cable is pulled out, or in again; power: it also starts anew. */
void brace_servos_plug(brace_servos_t *servos, int32_t servo, int32_t is_in);
void brace_servos_power(brace_servos_t *servos, int32_t servo, uint64_t now_ns);

/* Its hardware fails as register 70 says: its torque goes off and every answer has the alert bit. */
void brace_servos_break(brace_servos_t *servos, int32_t servo, uint8_t hardware_error);

/* Of the packets, on both ways, this share is damaged: up to three flipped bits, or a burst of up to 16. Each answer to
 * a fast sync read is one packet. */
void brace_servos_damage(brace_servos_t *servos, double share);

typedef struct {
    uint64_t heard, answered; /* packets */
    uint64_t damaged; /* by brace_servos_damage */
    uint64_t collisions; /* the master sent while a servo answered */
} brace_servos_counts_t;
void brace_servos_counts(const brace_servos_t *servos, brace_servos_counts_t *counts);

#endif
