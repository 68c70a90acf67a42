/* print_k BUS [NODE]: stiffness at the tip of a limb, with units, ten times.
 *   print_k can0 1 | print_k tcp://127.0.0.1:29536 | print_k modbus-tcp://127.0.0.1:1502 */
#include <stdio.h>
#include <stdlib.h>

#include <brace/client.h>

int main(int argc, char **argv)
{
    char why[BRACE_CLIENT_WHY_ROOM];
    brace_client_t *limb;
    brace_client_snapshot_t now;
    brace_client_status_t status;
    if (argc < 2) {
        fprintf(stderr, "usage: print_k BUS [NODE]\n");
        return 2;
    }
    status = brace_client_open(argv[1], argc > 2 ? (unsigned)atoi(argv[2]) : 0, 0, 2500, &limb, why, sizeof why);
    if (status != BRACE_CLIENT_OK) {
        fprintf(stderr, "print_k: %s\n", why);
        return brace_client_exit_code(status);
    }
    for (int i = 0; i < 10 && status == BRACE_CLIENT_OK; i++) {
        status = brace_client_read(limb, BRACE_PART_ALL, 2000, &now);
        if (status != BRACE_CLIENT_OK) {
            fprintf(stderr, "print_k: %s\n", brace_client_why(limb));
        } else if (!now.k_is_valid) {
            printf("K not valid: faults 0x%x\n", (unsigned)now.faults);
        } else {
            printf("k_xx %.4f k_xz %.4f k_zz %.4f N/mm, softest %.4f N/mm, stiff axis %.4f rad, flags 0x%02x\n",
                   now.k_xx_n_per_mm, now.k_xz_n_per_mm, now.k_zz_n_per_mm, now.lambda_min_n_per_mm,
                   now.stiff_axis_rad, (unsigned)now.flags);
        }
    }
    brace_client_close(limb);
    return status == BRACE_CLIENT_OK && !now.k_is_valid ? 5 : brace_client_exit_code(status);
}
