/* print_space BUS [NODE]: K in space of a limb whose coxa joint is fitted, and what its drift check says.
 *   print_space can0 1 | print_space tcp://127.0.0.1:29536 | print_space modbus-tcp://127.0.0.1:1502 */
#include <stdio.h>

#include "connect.h"

int main(int argc, char **argv)
{
    brace_client_t *limb = connect_limb(argc, argv);
    brace_client_snapshot_t now = {0};
    brace_client_drift_t drift;
    brace_client_status_t status = brace_client_read(limb, BRACE_PART_K | BRACE_PART_SPACE, 2000, &now);
    if (status == BRACE_CLIENT_OK) {
        const brace_client_space_k_t *k = &now.space.k;
        printf("[%.4f %.4f %.4f; %.4f %.4f %.4f; %.4f %.4f %.4f] N/mm, flags 0x%02x%s\n", k->k_xx_n_per_mm,
               k->k_xy_n_per_mm, k->k_xz_n_per_mm, k->k_xy_n_per_mm, k->k_yy_n_per_mm, k->k_yz_n_per_mm,
               k->k_xz_n_per_mm, k->k_yz_n_per_mm, k->k_zz_n_per_mm, (unsigned)k->flags,
               now.space.k_is_valid ? "" : ", not valid");
        status = brace_client_drift(limb, 2000, &drift);
    }
    if (status == BRACE_CLIENT_OK) {
        printf("%s %s %s\n", brace_drift_state_text((int32_t)drift.state), brace_drift_cause_text((int32_t)drift.cause),
               brace_drift_next_step_text((int32_t)drift.next_step));
    }
    const int code = disconnect_limb(limb, status);
    return code == 0 && !now.space.k_is_valid ? 5 : code;
}
