/* A plugin for QEMU's translator: how many instructions does each call of one function take, some callees
 * left out, and how many of them are another function's that it calls?
 *
 * Arguments: entry=ADDRESS inner=ADDRESS skip=LOW-HIGH out=FILE. A call is counted from the function's first
 * instruction until the one after the call is reached; what runs at LOW <= address < HIGH is not counted (the
 * harness's hardware). Counts whole
 * translated blocks, which is exact as long as no exception interrupts one: these images have none.
 * Output: for each call, in order, two little-endian 32-bit counts: the whole, and the most that a call of the inner
 * function takes in it, 0 where there is none.
 */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <qemu-plugin.h>

QEMU_PLUGIN_EXPORT int qemu_plugin_version = QEMU_PLUGIN_VERSION;

typedef struct {
    uint64_t first, last; /* addresses of its first instruction, and of the byte after its last */
    uint32_t count;
} block_t;

static uint64_t entry_address, inner_address, skip_low, skip_high, return_address, inner_return, previous_end;
static FILE *out;
static bool counting, is_inside;
static uint32_t count, inner_from, inner_most;

static void on_block(unsigned vcpu, void *data)
{
    (void)vcpu;
    const block_t *now = data;
    if (counting && now->first == return_address) {
        const uint32_t counts[] = {count, inner_most};
        fwrite(counts, sizeof counts, 1, out);
        counting = false;
    }
    if (is_inside && now->first == inner_return) {
        const uint32_t inner = count - inner_from;
        inner_most = inner > inner_most ? inner : inner_most;
        is_inside = false;
    }
    if (!counting && now->first == entry_address) {
        counting = true;
        count = inner_most = 0;
        return_address = previous_end;
    }
    if (counting && !is_inside && now->first == inner_address) {
        is_inside = true;
        inner_from = count;
        inner_return = previous_end;
    }
    if (counting && !(now->first >= skip_low && now->first < skip_high)) {
        count += now->count;
    }
    previous_end = now->last;
}

static void on_translation(qemu_plugin_id_t id, struct qemu_plugin_tb *block)
{
    (void)id;
    const size_t n = qemu_plugin_tb_n_insns(block);
    struct qemu_plugin_insn *last = qemu_plugin_tb_get_insn(block, n - 1);
    block_t *kept = malloc(sizeof *kept); /* lives as long as the translation: the whole run */
    kept->first = qemu_plugin_tb_vaddr(block);
    kept->last = qemu_plugin_insn_vaddr(last) + qemu_plugin_insn_size(last);
    kept->count = (uint32_t)n;
    qemu_plugin_register_vcpu_tb_exec_cb(block, on_block, QEMU_PLUGIN_CB_NO_REGS, kept);
}

static void on_exit_of_emulator(qemu_plugin_id_t id, void *data)
{
    (void)id;
    (void)data;
    fclose(out);
}

QEMU_PLUGIN_EXPORT int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t *info, int argc, char **argv)
{
    (void)info;
    for (int i = 0; i < argc; i++) {
        if (strncmp(argv[i], "entry=", 6) == 0) {
            entry_address = strtoull(argv[i] + 6, NULL, 0);
        } else if (strncmp(argv[i], "inner=", 6) == 0) {
            inner_address = strtoull(argv[i] + 6, NULL, 0);
        } else if (strncmp(argv[i], "skip=", 5) == 0) {
            char *rest;
            skip_low = strtoull(argv[i] + 5, &rest, 0);
            skip_high = strtoull(rest + 1, NULL, 0);
        } else if (strncmp(argv[i], "out=", 4) == 0) {
            out = fopen(argv[i] + 4, "wb");
        }
    }
    if (entry_address == 0 || inner_address == 0 || skip_high <= skip_low || out == NULL) {
        fprintf(stderr, "count_ticks: needs entry=ADDRESS, inner=ADDRESS, skip=LOW-HIGH and a writable out=FILE\n");
        return -1;
    }
    qemu_plugin_register_vcpu_tb_trans_cb(id, on_translation);
    qemu_plugin_register_atexit_cb(id, on_exit_of_emulator, NULL);
    return 0;
}
