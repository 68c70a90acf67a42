#include "banner.h"

#include "board.h"
#include "crash_words.h"
#include "image_info.h"
#include "key_entry.h"
#include "stack.h"

static void pair(text_t *text, const char *key, const char *value)
{
    text_string(text, key);
    text_string(text, ": ");
    text_string(text, value);
    text_line(text);
}

static void hex_field(text_t *text, const char *key, uint32_t value)
{
    text_string(text, " ");
    text_string(text, key);
    text_string(text, " ");
    text_hex(text, value);
}

static const char *cause_name(brace_reset_cause_t cause)
{
    static const char *const names[] = {"power", "requested", "watchdog", "fault", "pin"};
    return (uint32_t)cause < sizeof names / sizeof names[0] ? names[cause] : "unknown";
}

static void crash(text_t *text, const brace_crash_record_t *record)
{
    const char *const reason = crash_reason(record, stack_limit_address());
    text_string(text, "crash: ");
    text_string(text, crash_exception(record));
    if (reason[0] != '\0') {
        text_string(text, ", ");
        text_string(text, reason);
    }
    text_line(text);
    text_string(text, "crash-registers:");
    hex_field(text, "pc", record->pc);
    hex_field(text, "lr", record->lr);
    hex_field(text, "psr", record->psr);
    hex_field(text, "sp", record->sp);
    hex_field(text, "cfsr", record->cfsr);
    hex_field(text, "hfsr", record->hfsr);
    hex_field(text, "mmfar", record->mmfar);
    hex_field(text, "bfar", record->bfar);
    text_line(text);
    text_string(text, "crash-time: ");
    text_unsigned(text, record->uptime_us);
    text_string(text, " us after its start; number ");
    text_unsigned(text, record->count);
    text_string(text, " since power came on");
    text_line(text);
}

void banner_image(text_t *text)
{
    const brace_hal_t *const hal = text->hal;
    brace_crash_record_t record;
    text_line(text);
    text_string(text, "brace ");
    text_string(text, image_info.version);
    text_string(text, " (");
    text_string(text, image_info.hash);
    text_string(text, ", ");
    text_string(text, image_info.build);
    text_string(text, ") on ");
    text_string(text, hal->board);
    text_line(text);
    pair(text, "board", board_remark());
    pair(text, "start", cause_name(hal->reset_cause(hal->context)));
    if (hal->crash_read(hal->context, &record) == 1) {
        crash(text, &record);
    }
}

static const char *origin_name(brace_parameter_origin_t origin)
{
    switch (origin) {
    case BRACE_PARAMETERS_SLOT_A: return "slot A";
    case BRACE_PARAMETERS_SLOT_B: return "slot B";
    default: return "defaults, uncalibrated";
    }
}

void banner_application(text_t *text, const brace_app_t *app, brace_status_t started)
{
    const brace_hal_t *const hal = text->hal;
    const brace_snapshot_t *const now = brace_app_snapshot(app);
    if (started != BRACE_OK) {
        text_string(text, "application: refused to start, status ");
        text_signed(text, started);
        text_string(text, "; every mandatory entry of the door must be there");
        text_line(text);
        return;
    }
    text_string(text, "parameters: ");
    text_string(text, origin_name(now->parameter_origin));
    text_string(text, ", crc ");
    text_hex(text, now->parameter_crc);
    text_line(text);
    if (key_entry_words(hal)[0] != '\0') {
        pair(text, "key", key_entry_words(hal));
    }
    text_string(text, "stack: ");
    text_unsigned(text, hal->stack_unused_bytes(hal->context));
    text_string(text, " of ");
    text_unsigned(text, stack_bytes());
    text_string(text, " bytes never used");
    text_line(text);
}
