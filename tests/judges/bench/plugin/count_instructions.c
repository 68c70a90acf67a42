/* A plugin for QEMU's translator: how many instructions does one call of a function take, callees included?
 *
 * Arguments: entry=ADDRESS out=FILE [trace=CALL]. A call is counted from the function's first instruction up to,
 * and without, the instruction after the one that called it. The instruction that led to the entry must be a
 * Thumb BL or BLX (not a tail call); the plugin says so in the output if it is not.
 * Output, one line each: "call COUNT PATH" per call, in order, PATH a digest of the addresses executed: equal
 * digests, equal paths; with trace, "at ADDRESS" per instruction of that call.
 * An instruction under a failed IT condition is counted: it takes its slot in the processor as well.
 */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <qemu-plugin.h>

QEMU_PLUGIN_EXPORT int qemu_plugin_version = QEMU_PLUGIN_VERSION;

enum { ENCODING_BL_MASK_HIGH = 0xF800, ENCODING_BL_HIGH = 0xF000, ENCODING_BLX_MASK = 0xFF87, ENCODING_BLX = 0x4780 };

typedef struct {
    uint64_t address;
    uint32_t size;
    bool calls; /* a BL or BLX */
} instruction_t;

static uint64_t entry_address;
static long traced_call = -1;
static FILE *out;

static const instruction_t *previous;
static bool counting;
static uint64_t return_address;
static uint64_t count;
static uint64_t path; /* FNV-1a over the addresses */
static long calls_seen;

static bool is_call(const uint8_t *bytes, size_t size)
{
    const unsigned first = bytes[0] | (unsigned)bytes[1] << 8;
    if (size == 2) {
        return (first & ENCODING_BLX_MASK) == ENCODING_BLX;
    }
    const unsigned second = bytes[2] | (unsigned)bytes[3] << 8;
    return (first & ENCODING_BL_MASK_HIGH) == ENCODING_BL_HIGH && (second & 0xD000) == 0xD000;
}

static void on_instruction(unsigned vcpu, void *data)
{
    (void)vcpu;
    const instruction_t *now = data;
    if (counting && now->address == return_address) {
        fprintf(out, "call %llu %016llx\n", (unsigned long long)count, (unsigned long long)path);
        counting = false;
        calls_seen++;
    }
    if (!counting && now->address == entry_address) {
        if (previous == NULL || !previous->calls) {
            fprintf(out, "error: the function was not reached by a call instruction\n");
        } else {
            counting = true;
            count = 0;
            path = 0xcbf29ce484222325u;
            return_address = previous->address + previous->size;
        }
    }
    if (counting) {
        count++;
        path = (path ^ now->address) * 0x100000001b3u;
        if (calls_seen == traced_call) {
            fprintf(out, "at %llx\n", (unsigned long long)now->address);
        }
    }
    previous = now;
}

static void on_translation(qemu_plugin_id_t id, struct qemu_plugin_tb *block)
{
    (void)id;
    const size_t n = qemu_plugin_tb_n_insns(block);
    for (size_t i = 0; i < n; i++) {
        struct qemu_plugin_insn *insn = qemu_plugin_tb_get_insn(block, i);
        instruction_t *instruction = malloc(sizeof *instruction); /* lives as long as the translation: the whole run */
        instruction->address = qemu_plugin_insn_vaddr(insn);
        instruction->size = (uint32_t)qemu_plugin_insn_size(insn);
        instruction->calls = is_call(qemu_plugin_insn_data(insn), instruction->size);
        qemu_plugin_register_vcpu_insn_exec_cb(insn, on_instruction, QEMU_PLUGIN_CB_NO_REGS, instruction);
    }
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
        } else if (strncmp(argv[i], "trace=", 6) == 0) {
            traced_call = strtol(argv[i] + 6, NULL, 0);
        } else if (strncmp(argv[i], "out=", 4) == 0) {
            out = fopen(argv[i] + 4, "w");
        }
    }
    if (entry_address == 0 || out == NULL) {
        fprintf(stderr, "count_instructions: needs entry=ADDRESS and a writable out=FILE\n");
        return -1;
    }
    qemu_plugin_register_vcpu_tb_trans_cb(id, on_translation);
    qemu_plugin_register_atexit_cb(id, on_exit_of_emulator, NULL);
    return 0;
}
