/* client_probe BUS NODE TIMEOUT_MS CALL [NUMBER...]: one call of the C client; numbers it gives on stdout as "name
 * value" lines, its reason on stderr, its status as exit code (positive).
 *   identity | read PARTS COUNT | posture T1 T2 [COUNT] (the last one's) | tip X Z UP | force DX DZ | sag FX FZ
 *   load | under_load T1 T2 FX FZ [COUNT] (the last one's) | under_load_at_tip X Z UP FX FZ | gravity DIRECTION LEAN
 *   margin NORMAL MU | space COUNT (reads K in space) | space_posture T0 T1 T2 | drift | take_up JOINT
 *   space_under_load T0 T1 T2 FX FY FZ
 *   loop WAIT_MS FOR_MS: reads K in a control loop, each time with that time-out
 *   entry_u32 INDEX | entry_f32 INDEX | dump SILENT_MS [FRAMES] (bus only:
 *   until that silence, or that many) | send ID BYTE... (bus only) */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "brace/bus.h"
#include "brace/client.h"

static float numbers[12];
static int timeout_ms;

static int bus_call(const char *url, const char *call, int count)
{
    char why[BRACE_CLIENT_WHY_ROOM];
    brace_bus_t *bus;
    brace_bus_frame_t frame = {.id = (uint32_t)numbers[0], .length = (uint8_t)(count < 1 ? 0 : count - 1)};
    brace_bus_status_t status = brace_bus_open(url, 0u, timeout_ms, &bus, why, sizeof why);
    if (status != BRACE_BUS_OK) {
        fprintf(stderr, "%s\n", why);
        return -status;
    }
    if (strcmp(call, "send") == 0) {
        for (int i = 1; i < count && i <= 8; i++) {
            frame.data[i - 1] = (uint8_t)numbers[i];
        }
        status = brace_bus_send(bus, &frame, timeout_ms);
    } else {
        setvbuf(stdout, NULL, _IOLBF, 0u);
        printf("open\n");
        int left = count > 1 ? (int)numbers[1] : -1;
        while (left != 0 && (status = brace_bus_receive(bus, &frame, (int)numbers[0])) == BRACE_BUS_OK) {
            left -= left > 0;
            printf("%03x", (unsigned)frame.id);
            for (unsigned i = 0u; i < frame.length; i++) {
                printf("%s%02x", i == 0u ? " " : "", frame.data[i]);
            }
            printf("\n");
        }
        printf("errors %u\nlost %u\n", (unsigned)brace_bus_errors(bus, 200), (unsigned)brace_bus_lost(bus));
    }
    brace_bus_close(bus);
    return -status;
}

static void print_k(const brace_client_k_t *k)
{
    printf("k_xx %.9g\nk_xz %.9g\nk_zz %.9g\nlambda_min %.9g\nlambda_max %.9g\nstiff_axis %.9g\nflags %u\n",
           k->k_xx_n_per_mm, k->k_xz_n_per_mm, k->k_zz_n_per_mm, k->lambda_min_n_per_mm, k->lambda_max_n_per_mm,
           k->stiff_axis_rad, (unsigned)k->flags);
}

static void print_load(const brace_client_load_t *load)
{
    printf("is_counted %d\nforce_x %.9g\nforce_z %.9g\n", load->is_counted, load->force_x_n, load->force_z_n);
    printf("unloaded_k_xx %.9g\nunloaded_k_xz %.9g\nunloaded_k_zz %.9g\n", load->unloaded_k_xx_n_per_mm,
           load->unloaded_k_xz_n_per_mm, load->unloaded_k_zz_n_per_mm);
    printf("moved_x %.9g\nmoved_z %.9g\nbuckling_factor %.9g\n", load->moved_x_mm, load->moved_z_mm,
           load->buckling_factor);
    printf("gravity_direction %.9g\ngravity_lean %.9g\n", load->gravity_direction_rad, load->gravity_lean_rad);
    printf("force_y %.9g\nmoved_y %.9g\nunloaded_k_across %.9g\n", load->force_y_n, load->moved_y_mm,
           load->unloaded_k_across_n_per_mm);
}

static brace_client_status_t ask_under_load(brace_client_t *client, bool at_tip)
{
    const float *n = numbers;
    brace_client_loaded_k_t loaded;
    brace_client_status_t status;
    int left = at_tip ? 1 : (int)n[4];
    do {
        status =
            at_tip ? brace_client_k_under_load_at_tip(client, n[0], n[1], n[2] > 0.5f, n[3], n[4], timeout_ms, &loaded)
                   : brace_client_k_under_load_at_posture(client, n[0], n[1], n[2], n[3], timeout_ms, &loaded);
    } while (status == BRACE_CLIENT_OK && --left > 0);
    if (status == BRACE_CLIENT_OK) {
        print_k(&loaded.k);
        printf("moved_x %.9g\nmoved_z %.9g\nbuckling_factor %.9g\n", loaded.moved_x_mm, loaded.moved_z_mm,
               loaded.buckling_factor);
    }
    return status;
}

static brace_client_status_t read_some(brace_client_t *client)
{
    for (int i = 0; i < (int)numbers[1]; i++) {
        brace_client_snapshot_t s;
        const brace_client_status_t status = brace_client_read(client, (uint32_t)numbers[0], timeout_ms, &s);
        if (status != BRACE_CLIENT_OK) {
            return status;
        }
        const brace_client_k_t k = {s.k_xx_n_per_mm,       s.k_xz_n_per_mm,  s.k_zz_n_per_mm, s.lambda_min_n_per_mm,
                                    s.lambda_max_n_per_mm, s.stiff_axis_rad, s.flags};
        printf("snapshot %u\nparts %u\nvalid %d\nage_ms %.9g\ntheta1 %.9g\ntheta2 %.9g\nmode %u\nfaults %u\n",
               (unsigned)s.sequence, (unsigned)s.parts, s.k_is_valid, s.age_ms, s.theta1_rad, s.theta2_rad,
               (unsigned)s.mode, (unsigned)s.faults);
        print_k(&k);
        if ((s.parts & BRACE_PART_LOAD) != 0u) {
            print_load(&s.load);
        }
    }
    return BRACE_CLIENT_OK;
}

static void print_space_k(const brace_client_space_k_t *k)
{
    printf("k_xx %.9g\nk_xy %.9g\nk_xz %.9g\nk_yy %.9g\nk_yz %.9g\nk_zz %.9g\n", k->k_xx_n_per_mm, k->k_xy_n_per_mm,
           k->k_xz_n_per_mm, k->k_yy_n_per_mm, k->k_yz_n_per_mm, k->k_zz_n_per_mm);
    printf("lambda_1 %.9g\nlambda_2 %.9g\nlambda_3 %.9g\nflags %u\n", k->lambda_n_per_mm[0], k->lambda_n_per_mm[1],
           k->lambda_n_per_mm[2], (unsigned)k->flags);
}

static brace_client_status_t read_space(brace_client_t *client)
{
    for (int i = 0; i < (int)numbers[0]; i++) {
        brace_client_snapshot_t s;
        const brace_client_status_t status =
            brace_client_read(client, BRACE_PART_ALL | BRACE_PART_SPACE, timeout_ms, &s);
        if (status != BRACE_CLIENT_OK) {
            return status;
        }
        printf("snapshot %u\nparts %u\nvalid %d\ntheta0 %.9g\ntheta1 %.9g\ntheta2 %.9g\n", (unsigned)s.sequence,
               (unsigned)s.parts, s.space.k_is_valid, s.space.theta0_rad, s.theta1_rad, s.theta2_rad);
        printf("axis_x %.9g\naxis_y %.9g\naxis_z %.9g\nacross %.9g\nplay_coxa %u\n", s.space.stiff_axis[0],
               s.space.stiff_axis[1], s.space.stiff_axis[2], s.space.k_across_n_per_mm, (unsigned)s.space.play_coxa);
        print_space_k(&s.space.k);
    }
    return BRACE_CLIENT_OK;
}

static brace_client_status_t print_drift(brace_client_t *client)
{
    brace_client_drift_t drift;
    const brace_client_status_t status = brace_client_drift(client, timeout_ms, &drift);
    if (status == BRACE_CLIENT_OK) {
        printf("state %u\ncause %u\ncould_be %u\nnext_step %u\nevidence %.9g\nloss_ratio %.9g\nreadings %u\n",
               (unsigned)drift.state, (unsigned)drift.cause, (unsigned)drift.could_be, (unsigned)drift.next_step,
               drift.evidence, drift.loss_ratio, (unsigned)drift.readings);
        fprintf(stderr, "%s %s\n", brace_drift_state_text((int32_t)drift.state),
                brace_drift_next_step_text((int32_t)drift.next_step));
    }
    return status;
}

static brace_client_status_t print_take_up(brace_client_t *client)
{
    int32_t outcome;
    const brace_client_status_t status = brace_client_take_up(client, (uint32_t)numbers[0], timeout_ms, &outcome);
    if (status == BRACE_CLIENT_OK) {
        printf("outcome %d\n", (int)outcome);
        fprintf(stderr, "%s\n", brace_take_up_outcome_text(outcome));
    }
    return status;
}

static double now_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

/* Counts, and the last failure's status. */
static void read_in_a_loop(brace_client_t *client)
{
    const double end_ms = now_ms() + (double)numbers[1];
    int good = 0, failed = 0, good_again = 0, last_failure = 0;
    while (now_ms() < end_ms && last_failure != -BRACE_CLIENT_E_DOWN) {
        brace_client_snapshot_t s;
        const brace_client_status_t status = brace_client_read(client, BRACE_PART_K, (int)numbers[0], &s);
        if (status == BRACE_CLIENT_OK) {
            good++;
            good_again += failed > 0;
        } else {
            failed++;
            last_failure = -(int)status;
        }
    }
    printf("good %d\nfailed %d\ngood_again %d\nlast_failure %d\n", good, failed, good_again, last_failure);
}

static brace_client_status_t client_call(brace_client_t *client, const char *call)
{
    const float *n = numbers;
    const uint32_t index = (uint32_t)n[0];
    brace_client_status_t status = BRACE_CLIENT_E_USAGE;
    brace_client_k_t k;
    if (strcmp(call, "identity") == 0) {
        brace_client_identity_t who;
        brace_client_identity(client, &who);
        printf("node %u\nhash %u\nversion %u\ncrc %u\norigin %u\n", (unsigned)who.node, (unsigned)who.dictionary_hash,
               (unsigned)who.firmware_version, (unsigned)who.parameter_crc, (unsigned)who.parameter_origin);
        status = BRACE_CLIENT_OK;
    } else if (strcmp(call, "read") == 0) {
        status = read_some(client);
    } else if (strcmp(call, "loop") == 0) {
        read_in_a_loop(client);
        status = BRACE_CLIENT_OK;
    } else if (strcmp(call, "posture") == 0 || strcmp(call, "tip") == 0) {
        int left = call[0] == 'p' ? (int)n[2] : 1;
        do {
            status = call[0] == 'p' ? brace_client_k_at_posture(client, n[0], n[1], timeout_ms, &k)
                                    : brace_client_k_at_tip(client, n[0], n[1], n[2] > 0.5f, timeout_ms, &k);
        } while (status == BRACE_CLIENT_OK && --left > 0);
        if (status == BRACE_CLIENT_OK) {
            print_k(&k);
        }
    } else if (strcmp(call, "load") == 0) {
        brace_client_load_t load;
        status = brace_client_load(client, timeout_ms, &load);
        if (status == BRACE_CLIENT_OK) {
            print_load(&load);
        }
    } else if (strcmp(call, "under_load") == 0 || strcmp(call, "under_load_at_tip") == 0) {
        status = ask_under_load(client, strcmp(call, "under_load_at_tip") == 0);
    } else if (strcmp(call, "gravity") == 0) {
        status = brace_client_set_gravity(client, n[0], n[1], timeout_ms);
    } else if (strcmp(call, "space") == 0) {
        status = read_space(client);
    } else if (strcmp(call, "space_posture") == 0) {
        brace_client_space_k_t space;
        status = brace_client_k_in_space(client, n[0], n[1], n[2], timeout_ms, &space);
        if (status == BRACE_CLIENT_OK) {
            print_space_k(&space);
        }
    } else if (strcmp(call, "space_under_load") == 0) {
        brace_client_loaded_space_k_t loaded;
        status = brace_client_k_in_space_under_load(client, n, n + 3, timeout_ms, &loaded);
        if (status == BRACE_CLIENT_OK) {
            print_space_k(&loaded.k);
            printf("moved_x %.9g\nmoved_y %.9g\nmoved_z %.9g\n", loaded.moved_x_mm, loaded.moved_y_mm,
                   loaded.moved_z_mm);
        }
    } else if (strcmp(call, "drift") == 0) {
        status = print_drift(client);
    } else if (strcmp(call, "take_up") == 0) {
        status = print_take_up(client);
    } else if (strcmp(call, "force") == 0) {
        brace_client_force_t force;
        status = brace_client_contact_force(client, n[0], n[1], timeout_ms, &force);
        if (status == BRACE_CLIENT_OK) {
            printf("fx %.9g\nfz %.9g\nlow %.9g\nhigh %.9g\n", force.fx_n, force.fz_n, force.low_n, force.high_n);
        }
    } else if (strcmp(call, "sag") == 0) {
        float dx_mm, dz_mm;
        status = brace_client_sag(client, n[0], n[1], timeout_ms, &dx_mm, &dz_mm);
        if (status == BRACE_CLIENT_OK) {
            printf("dx %.9g\ndz %.9g\n", dx_mm, dz_mm);
        }
    } else if (strcmp(call, "margin") == 0) {
        brace_client_margin_t margin;
        status = brace_client_margin(client, n[0], n[1], timeout_ms, &margin);
        if (status == BRACE_CLIENT_OK) {
            printf("margin %.9g\nangle_left %.9g\ncontact %u\n", margin.margin_n, margin.angle_left_rad,
                   (unsigned)margin.contact);
        }
    } else if (strcmp(call, "entry_u32") == 0) {
        uint32_t value;
        status = brace_client_entry_u32(client, index, timeout_ms, &value);
        if (status == BRACE_CLIENT_OK) {
            printf("value %u\n", (unsigned)value);
        }
    } else if (strcmp(call, "entry_f32") == 0) {
        float value;
        status = brace_client_entry_f32(client, index, timeout_ms, &value);
        if (status == BRACE_CLIENT_OK) {
            printf("value %.9g\n", value);
        }
    }
    if (status != BRACE_CLIENT_OK) {
        fprintf(stderr, "%s\nrefusal %d\n", brace_client_why(client), (int)brace_client_refusal(client));
    }
    return status;
}

int main(int argc, char **argv)
{
    char why[BRACE_CLIENT_WHY_ROOM];
    brace_client_t *client;
    if (argc < 5) {
        fprintf(stderr, "usage: client_probe BUS NODE TIMEOUT_MS CALL [NUMBER...]\n");
        return 64;
    }
    timeout_ms = atoi(argv[3]);
    for (int i = 5; i < argc && i - 5 < 12; i++) {
        numbers[i - 5] = strtof(argv[i], NULL);
    }
    if (strcmp(argv[4], "dump") == 0 || strcmp(argv[4], "send") == 0) {
        return bus_call(argv[1], argv[4], argc - 5);
    }
    brace_client_status_t status =
        brace_client_open(argv[1], (uint32_t)atoi(argv[2]), 0u, timeout_ms, &client, why, sizeof why);
    if (status != BRACE_CLIENT_OK) {
        fprintf(stderr, "%s\nexit %d\n", why, brace_client_exit_code(status));
        return -status;
    }
    status = client_call(client, argv[4]);
    brace_client_close(client);
    return -status;
}
