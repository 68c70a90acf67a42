/* What the harness asks of a version under test: prepare once, then one K at a time. */
#ifndef BENCH_JOB_H
#define BENCH_JOB_H

/* Six numbers for the plane: K_xx, K_xz, K_zz, lambda_min, lambda_max [N/mm], stiff axis [rad].
 * Under a load three more: displacement of the tip along x and z [mm], buckling factor.
 * Twelve for space: K_xx, K_xy, K_xz, K_yy, K_yz, K_zz, the eigenvalues ascending, the unit stiff axis. */
enum { JOB_OUT_MAX = 12 };

extern const int job_runs;      /* how many indices there are */
extern const int job_out_count; /* how many numbers a run gives */

void job_setup(void);
void job_run(int index, float *out);

#endif
