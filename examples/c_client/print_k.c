/* print_k BUS [NODE]: stiffness at the tip of a limb, with units, ten times.
 *   print_k can0 1 | print_k tcp://127.0.0.1:29536 | print_k modbus-tcp://127.0.0.1:1502 */
#include <stdio.h>

#include "connect.h"

int main(int argc, char **argv)
{
    brace_client_t *limb = connect_limb(argc, argv);
    brace_client_snapshot_t now = {0};
    brace_client_status_t status = BRACE_CLIENT_OK;
    for (int i = 0; i < 10 && status == BRACE_CLIENT_OK; i++) {
        status = brace_client_read(limb, BRACE_PART_ALL, 2000, &now);
        if (status == BRACE_CLIENT_OK && now.k_is_valid) {
            printf("k_xx %.4f k_xz %.4f k_zz %.4f N/mm, softest %.4f N/mm, stiff axis %.4f rad, flags 0x%02x\n",
                   now.k_xx_n_per_mm, now.k_xz_n_per_mm, now.k_zz_n_per_mm, now.lambda_min_n_per_mm, now.stiff_axis_rad,
                   (unsigned)now.flags);
        } else if (status == BRACE_CLIENT_OK) {
            printf("K not valid: faults 0x%x\n", (unsigned)now.faults);
        }
    }
    const int code = disconnect_limb(limb, status);
    return code == 0 && !now.k_is_valid ? 5 : code;
}
