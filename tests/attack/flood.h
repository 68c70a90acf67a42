/* A limb on its way, whose owner gives its signs of life over CAN, and whoever floods its ports. */
#ifndef FLOOD_H
#define FLOOD_H

#include <stdlib.h>

#include "attack.h"

enum {
    REQUESTS_PER_MS = 8,
    BURST_MOST = 500,
    TICKS_AFTER = 25,
    STANDS_WITHIN = 2 /* ticks, after the one that the stop came before */
};

static uint32_t trials = 400;
static uint64_t dice = 0x9e3779b97f4a7c15u;

static inline uint32_t below(uint32_t n)
{
    dice ^= dice << 13;
    dice ^= dice >> 7;
    dice ^= dice << 17;
    return (uint32_t)((dice >> 32) * n >> 32);
}

/* ------------------------------------------------------------------------------------------- who floods -- */

typedef enum { K_QUESTIONS, ANY_QUESTIONS, ANY_REQUESTS, FORGED_SEALS, OTHER_NODES, FLOODS } flood_t;

static const char *const flood_name[FLOODS] = {"questions for K", "any questions", "any requests", "forged seals",
                                               "requests to other nodes"};

static inline bool ends_the_motion(const uint8_t data[8])
{
    const uint32_t entry = (uint32_t)data[2] | (uint32_t)data[3] << 8;
    return data[0] == BRACE_REQUEST_LOADING_TEST_STOP ||
           (data[0] == BRACE_REQUEST_WRITE_ENTRY && (entry == COMMAND_ENTRY(stop) || entry == COMMAND_ENTRY(end_test)));
}

/* Something that a stranger may send. Only a stop is left out, and on a bench whatever says that it is the owner's. */
static inline void make_noise(flood_t flood, uint8_t data[8])
{
    static const uint8_t about_k[] = {BRACE_REQUEST_K_AT_POSTURE, BRACE_REQUEST_K_AT_TIP_KNEE_UP,
                                      BRACE_REQUEST_K_UNDER_LOAD_AT_POSTURE, BRACE_REQUEST_K_IN_SPACE_AT_POSTURE};
    static const uint8_t questions[] = {BRACE_REQUEST_READ_ENTRY,    BRACE_REQUEST_IDENTIFY,
                                        BRACE_REQUEST_TIP_FORCE,     BRACE_REQUEST_DOWNLOAD_WORD,
                                        BRACE_REQUEST_CONTACT_FORCE, BRACE_REQUEST_FRICTION_MARGIN,
                                        BRACE_REQUEST_K_AT_POSTURE,  BRACE_REQUEST_FETCH_ROW};
    do {
        for (int i = 0; i < 8; i++) {
            data[i] = (uint8_t)below(256);
        }
        switch (flood) {
        case K_QUESTIONS: data[0] = about_k[below(sizeof about_k)]; break;
        case ANY_QUESTIONS: data[0] = questions[below(sizeof questions)]; break;
        case FORGED_SEALS:
            if (below(2) == 0u) {
                make_write(COMMAND_ENTRY(seal_mac), below(UINT32_MAX), (counter + below(4)) & 0xffu, data);
                data[0] = (uint8_t)(below(2) == 0u ? BRACE_REQUEST_WRITE_ENTRY : BRACE_REQUEST_SIGN_OF_LIFE);
                break;
            }
            data[0] = (uint8_t)(below(2) == 0u ? BRACE_REQUEST_LET_GO : BRACE_REQUEST_TAKE_UP);
            data[1] = (uint8_t)(counter + below(4));
            break;
        default: data[0] = (uint8_t)below(40); break;
        }
        if (!is_guarded() && data[1] >> 4 == MASTER_OF_OPERATOR) {
            data[1] ^= 0x80u;
        }
    } while (ends_the_motion(data));
}

static inline void frame_arrives(uint32_t id, const uint8_t *data, uint8_t length)
{
    brace_can_frame_t frame = {.id = id, .length = length};
    if (length > 0u) {
        memcpy(frame.data, data, length);
    }
    (void)brace_fake_frame_arrives(&fake, &frame);
}

static inline void noise_arrives(flood_t flood, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint8_t data[8];
        make_noise(flood, data);
        frame_arrives(flood == OTHER_NODES ? 2u + below(0x7feu) : 0x600u + NODE, data, 8);
    }
}

static inline void empty_the_bus(void)
{
    brace_can_frame_t frame;
    for (int i = 0; i < 3 && brace_fake_frame_take(&fake, &frame); i++) { /* as many as the STM32 has mailboxes */
    }
}

/* A millisecond of a full bus; the owner gives its sign of life in time. */
static inline void flooded_tick(flood_t flood, uint32_t noise)
{
    static uint32_t since;
    const bool lives = ++since >= 40u;
    noise_arrives(flood, noise / 2u);
    if (lives) {
        since = 0;
        sign_of_life();
    }
    noise_arrives(flood, noise > 0u ? noise - noise / 2u - lives : 0u);
    ticks(1);
    empty_the_bus();
}

typedef struct {
    float offset_rad[BRACE_LINK_COUNT];
} set_points_t;

static inline set_points_t set_points(void)
{
    set_points_t points;
    for (int i = 0; i < BRACE_LINK_COUNT; i++) {
        points.offset_rad[i] = fake.joint[i].command.offset_rad;
    }
    return points;
}

static inline bool are_equal(const set_points_t *a, const set_points_t *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

static inline void begin_trial(bool guarded, bool in_space)
{
    has_coxa = in_space;
    start_limb(guarded, guarded ? the_key : NULL);
    fake.can_filters = true;
    if (guarded) {
        open_session();
    }
    begin_to_move();
}

/* How many trials there are: the program's first argument, else this. */
static inline void read_trials(int count, char **arguments)
{
    trials = count > 1 ? (uint32_t)strtoul(arguments[1], NULL, 10) : trials;
}

#endif
