/* Written by brace export --c; do not edit. limb.h is the manual. Compiles as C11 and as C++17. */
/* clang-format off */
#include "limb.h"

#include <assert.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* The numbers below stand in the order of the headers' members. */
#define HAS_BYTES(type, bytes) \
    static_assert(sizeof(type) == (bytes), #type " is another version's: export the limb again")
#define IS_AT(type, member, bytes) \
    static_assert(offsetof(type, member) == (bytes), #member " has moved: export the limb again")
IS_AT(brace_limb_t, coxa_mm, 0);
IS_AT(brace_limb_t, femur_mm, 4);
IS_AT(brace_limb_t, tibia_mm, 8);
IS_AT(brace_limb_t, link[0].axial_mm_per_n, 12);
IS_AT(brace_limb_t, link[0].bending_mm_per_n, 16);
IS_AT(brace_limb_t, link[0].tilt_rad, 20);
IS_AT(brace_limb_t, link[0].lateral_mm_per_n, 24);
IS_AT(brace_limb_t, link[0].torsion_rad_per_n_mm, 28);
IS_AT(brace_limb_t, link[0].moment_transfer, 32);
IS_AT(brace_limb_t, link[1].axial_mm_per_n, 36);
IS_AT(brace_limb_t, link[1].bending_mm_per_n, 40);
IS_AT(brace_limb_t, link[1].tilt_rad, 44);
IS_AT(brace_limb_t, link[1].lateral_mm_per_n, 48);
IS_AT(brace_limb_t, link[1].torsion_rad_per_n_mm, 52);
IS_AT(brace_limb_t, link[1].moment_transfer, 56);
IS_AT(brace_limb_t, link[2].axial_mm_per_n, 60);
IS_AT(brace_limb_t, link[2].bending_mm_per_n, 64);
IS_AT(brace_limb_t, link[2].tilt_rad, 68);
IS_AT(brace_limb_t, link[2].lateral_mm_per_n, 72);
IS_AT(brace_limb_t, link[2].torsion_rad_per_n_mm, 76);
IS_AT(brace_limb_t, link[2].moment_transfer, 80);
IS_AT(brace_limb_t, joint[0].compliance_rad_per_n_mm, 84);
IS_AT(brace_limb_t, joint[0].gap_rad, 88);
IS_AT(brace_limb_t, joint[0].zero_offset_rad, 92);
IS_AT(brace_limb_t, joint[1].compliance_rad_per_n_mm, 96);
IS_AT(brace_limb_t, joint[1].gap_rad, 100);
IS_AT(brace_limb_t, joint[1].zero_offset_rad, 104);
IS_AT(brace_limb_t, joint[2].compliance_rad_per_n_mm, 108);
IS_AT(brace_limb_t, joint[2].gap_rad, 112);
IS_AT(brace_limb_t, joint[2].zero_offset_rad, 116);
IS_AT(brace_limb_t, base.x_mm_per_n, 120);
IS_AT(brace_limb_t, base.z_mm_per_n, 124);
IS_AT(brace_limb_t, base.rotation_rad_per_n_mm, 128);
IS_AT(brace_limb_t, uncertainty.length_mm, 132);
IS_AT(brace_limb_t, uncertainty.angle_rad, 136);
IS_AT(brace_limb_t, uncertainty.compliance_rel, 140);
IS_AT(brace_limb_t, uncertainty.gain_rel, 144);
HAS_BYTES(brace_limb_t, 148);
IS_AT(brace_gravity_t, femur_n, 0);
IS_AT(brace_gravity_t, tibia_n, 4);
IS_AT(brace_gravity_t, knee_n, 8);
IS_AT(brace_gravity_t, direction_rad, 12);
IS_AT(brace_gravity_t, lean_rad, 16);
HAS_BYTES(brace_gravity_t, 20);
HAS_BYTES(brace_planar_t, 60);
HAS_BYTES(brace_loaded_t, 120);

const brace_limb_t limb = {
    57.0f, /* coxa_mm */
    185.0f, /* femur_mm */
    313.5f, /* tibia_mm */
    {
        {
            0.0f, /* link[BRACE_COXA].axial_mm_per_n */
            0.0f, /* link[BRACE_COXA].bending_mm_per_n */
            0.0f, /* link[BRACE_COXA].tilt_rad */
            0.0f, /* link[BRACE_COXA].lateral_mm_per_n */
            0.0f, /* link[BRACE_COXA].torsion_rad_per_n_mm */
            0.0f, /* link[BRACE_COXA].moment_transfer */
        }, /* link[BRACE_COXA] */
        {
            0.001f, /* link[BRACE_FEMUR].axial_mm_per_n */
            0.06f, /* link[BRACE_FEMUR].bending_mm_per_n */
            0.0f, /* link[BRACE_FEMUR].tilt_rad */
            0.0f, /* link[BRACE_FEMUR].lateral_mm_per_n */
            0.0f, /* link[BRACE_FEMUR].torsion_rad_per_n_mm */
            0.0f, /* link[BRACE_FEMUR].moment_transfer */
        }, /* link[BRACE_FEMUR] */
        {
            0.002f, /* link[BRACE_TIBIA].axial_mm_per_n */
            0.25f, /* link[BRACE_TIBIA].bending_mm_per_n */
            0.0f, /* link[BRACE_TIBIA].tilt_rad */
            0.0f, /* link[BRACE_TIBIA].lateral_mm_per_n */
            0.0f, /* link[BRACE_TIBIA].torsion_rad_per_n_mm */
            0.0f, /* link[BRACE_TIBIA].moment_transfer */
        }, /* link[BRACE_TIBIA] */
    }, /* link */
    {
        {
            0.0f, /* joint[BRACE_COXA].compliance_rad_per_n_mm */
            0.0f, /* joint[BRACE_COXA].gap_rad */
            0.0f, /* joint[BRACE_COXA].zero_offset_rad */
        }, /* joint[BRACE_COXA] */
        {
            1e-05f, /* joint[BRACE_FEMUR].compliance_rad_per_n_mm */
            0.0f, /* joint[BRACE_FEMUR].gap_rad */
            0.0f, /* joint[BRACE_FEMUR].zero_offset_rad */
        }, /* joint[BRACE_FEMUR] */
        {
            1.6e-05f, /* joint[BRACE_TIBIA].compliance_rad_per_n_mm */
            0.0f, /* joint[BRACE_TIBIA].gap_rad */
            0.0f, /* joint[BRACE_TIBIA].zero_offset_rad */
        }, /* joint[BRACE_TIBIA] */
    }, /* joint */
    {
        0.0f, /* base.x_mm_per_n */
        0.0f, /* base.z_mm_per_n */
        0.0f, /* base.rotation_rad_per_n_mm */
    }, /* base */
    {
        0.5f, /* uncertainty.length_mm */
        0.003f, /* uncertainty.angle_rad */
        0.05f, /* uncertainty.compliance_rel */
        0.005f, /* uncertainty.gain_rel */
    }, /* uncertainty */
};

const brace_gravity_t limb_weights = {
    0.0f, /* femur_n */
    0.0f, /* tibia_n */
    0.0f, /* knee_n */
    -1.5707964f, /* direction_rad */
    0.0f, /* lean_rad */
};

const brace_planar_t limb_planar = {
    {
        1.0253193f, /* mean.at_fold */
        1.15995f, /* mean.per_cos2 */
        0.0f, /* mean.per_sincos */
    }, /* mean */
    {
        1.0223193f, /* dev_x.at_fold */
        -3.2045887f, /* dev_x.per_cos2 */
        0.0f, /* dev_x.per_sincos */
    }, /* dev_x */
    {
        0.0f, /* dev_z.at_fold */
        0.0f, /* dev_z.per_cos2 */
        2.4020886f, /* dev_z.per_sincos */
    }, /* dev_z */
    0.0f, /* cross_least */
    1.7759151f, /* cross_factor */
    -0.0f, /* zero_tan */
    -0.0f, /* zero_cot */
    -9e-06f, /* rest_constant */
    0.006f, /* rest_per_mean */
};

const brace_loaded_t limb_loaded = {
    {
        185.0f, /* femur.length_mm */
        {
            0.0f, /* femur.to_beam_mm.x */
            -0.0f, /* femur.to_beam_mm.z */
        }, /* femur.to_beam_mm */
        {
            185.0f, /* femur.beam_mm.x */
            0.0f, /* femur.beam_mm.z */
        }, /* femur.beam_mm */
        0.0f, /* femur.bend_rad_per_n_mm */
        {
            0.0f, /* femur.root_root.x */
            0.0f, /* femur.root_root.z */
        }, /* femur.root_root */
        {
            -0.0f, /* femur.end_root.x */
            0.24289915f, /* femur.end_root.z */
        }, /* femur.end_root */
        0.001f, /* femur.end_mm_per_n */
        0.0f, /* femur.weight_n */
    }, /* femur */
    {
        313.5f, /* tibia.length_mm */
        {
            0.0f, /* tibia.to_beam_mm.x */
            -0.0f, /* tibia.to_beam_mm.z */
        }, /* tibia.to_beam_mm */
        {
            313.5f, /* tibia.beam_mm.x */
            0.0f, /* tibia.beam_mm.z */
        }, /* tibia.beam_mm */
        0.0f, /* tibia.bend_rad_per_n_mm */
        {
            0.0f, /* tibia.root_root.x */
            0.0f, /* tibia.root_root.z */
        }, /* tibia.root_root */
        {
            -0.0f, /* tibia.end_root.x */
            0.49799597f, /* tibia.end_root.z */
        }, /* tibia.end_root */
        0.002f, /* tibia.end_mm_per_n */
        0.0f, /* tibia.weight_n */
    }, /* tibia */
    0.0f, /* knee_n */
    0.0f, /* weight_n */
    0.0f, /* base_mm_per_n */
    {
        0.0f, /* base_root.x */
        0.0f, /* base_root.z */
    }, /* base_root */
    0.0f, /* base_rotation_rad_per_n_mm */
};

/* CRC-32 (IEEE 802.3, reflected), continued from `crc`, over 32-bit words, the lowest byte of each first. */
static uint32_t crc32_of(uint32_t crc, const void *data, size_t bytes)
{
    crc = ~crc;
    for (size_t at = 0; at < bytes; at += sizeof crc) {
        uint32_t word;
        memcpy(&word, (const char *)data + at, sizeof word);
        crc ^= word;
        for (int bit = 0; bit < 32; bit++) {
            crc = (crc & 1u) != 0u ? (crc >> 1) ^ 0xEDB88320u : crc >> 1;
        }
    }
    return ~crc;
}

brace_status_t limb_check(void)
{
    uint32_t crc = crc32_of(0u, &limb, sizeof limb);
    crc = crc32_of(crc, &limb_weights, sizeof limb_weights);
    if (crc != 0x27515cc6u) {
        return BRACE_E_CHECKSUM;
    }
    brace_status_t status = brace_limb_check(&limb);
    if (status == BRACE_OK) {
        brace_planar_t made;
        status = brace_planar_collapse(&limb, &made);
        if (status == BRACE_OK && memcmp(&made, &limb_planar, sizeof made) != 0) {
            status = BRACE_E_SCHEMA;
        }
    }
    if (status == BRACE_OK) {
        brace_loaded_t made;
        brace_loaded_collapse(&limb, &limb_weights, &made);
        if (status == BRACE_OK && memcmp(&made, &limb_loaded, sizeof made) != 0) {
            status = BRACE_E_SCHEMA;
        }
    }
    return status;
}
