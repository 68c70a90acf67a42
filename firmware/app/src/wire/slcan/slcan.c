#include "wire/slcan/slcan.h"

#include <string.h>

#define CR '\r'
#define BEL '\a'
#define LINES_MOST 64u   /* that are no frame for the node, one after another */
#define DATA_MOST 8u     /* bytes of a classic frame */
#define NOT_A_DIGIT 16u

void slcan_start(slcan_t *slcan, const brace_hal_t *hal, uint32_t urgent_id)
{
    *slcan = (slcan_t){.urgent_id = urgent_id};
    slcan->is_fitted =
        hal->serial_setup != NULL && hal->serial_read != NULL && hal->serial_write != NULL &&
        hal->serial_setup(hal->context, BRACE_SERIAL_SLCAN, SLCAN_BAUD, BRACE_PARITY_NONE) == BRACE_HAL_OK;
}

/* ---------------------------------------------------------------------------------------------- out -- */

/* Makes room for so many bytes behind those that wait, where there is any. Nothing is moved in vain: a line that takes
 * next to nothing would make every frame of every tick move the whole buffer. */
static bool make_room(slcan_t *slcan, uint32_t count)
{
    const bool has_room = slcan->out_count + count <= (uint32_t)SLCAN_OUT_BYTES;
    if (has_room && (uint32_t)slcan->out_first + slcan->out_count + count > (uint32_t)SLCAN_OUT_BYTES) {
        memmove(slcan->out, slcan->out + slcan->out_first, slcan->out_count);
        slcan->out_first = 0;
    }
    return has_room;
}

static uint8_t *end_of_out(slcan_t *slcan)
{
    return slcan->out + slcan->out_first + slcan->out_count;
}

/* Every byte as two digits, one after the other: 512 bytes of flash halve what a frame costs as text. A tick may send
 * eight of them. */
#define BYTES_OF(high) \
    high "0" high "1" high "2" high "3" high "4" high "5" high "6" high "7" high "8" high "9" high "A" high "B" high \
         "C" high "D" high "E" high "F"
static const char hex_byte[] =
    BYTES_OF("0") BYTES_OF("1") BYTES_OF("2") BYTES_OF("3") BYTES_OF("4") BYTES_OF("5") BYTES_OF("6") BYTES_OF("7")
        BYTES_OF("8") BYTES_OF("9") BYTES_OF("A") BYTES_OF("B") BYTES_OF("C") BYTES_OF("D") BYTES_OF("E") BYTES_OF("F");
#undef BYTES_OF

static uint8_t hex_digit(uint32_t value)
{
    return (uint8_t)hex_byte[2u * (value & 15u) + 1u];
}

bool slcan_send(slcan_t *slcan, const brace_can_frame_t *frame)
{
    const uint32_t count = frame->length;
    if (count > DATA_MOST || !make_room(slcan, 6u + 2u * count)) {
        return false;
    }
    uint8_t *line = end_of_out(slcan);
    line[0] = 't';
    line[1] = hex_digit(frame->id >> 8);
    line[2] = hex_digit(frame->id >> 4);
    line[3] = hex_digit(frame->id);
    line[4] = (uint8_t)('0' + count);
    for (uint32_t i = 0; i < count; i++) {
        memcpy(&line[5u + 2u * i], &hex_byte[2u * frame->data[i]], 2);
    }
    line[5u + 2u * count] = CR;
    slcan->out_count = (uint16_t)(slcan->out_count + 6u + 2u * count);
    return true;
}

void slcan_flush(slcan_t *slcan, const brace_hal_t *hal)
{
    if (slcan->out_count == 0u) {
        return;
    }
    const int32_t written =
        hal->serial_write(hal->context, BRACE_SERIAL_SLCAN, slcan->out + slcan->out_first, slcan->out_count);
    if (written > 0 && written <= (int32_t)slcan->out_count) {
        slcan->out_count = (uint16_t)(slcan->out_count - written);
        slcan->out_first = slcan->out_count > 0u ? (uint16_t)(slcan->out_first + written) : (uint16_t)0u;
    }
}

/* The reply to a command. What finds no room is lost, as an adapter's is. */
static void reply(slcan_t *slcan, const char *text, uint32_t count)
{
    if (make_room(slcan, count)) {
        memcpy(end_of_out(slcan), text, count);
        slcan->out_count = (uint16_t)(slcan->out_count + count);
    }
}

static void reply_yes_or_no(slcan_t *slcan, bool yes)
{
    const char word = yes ? CR : BEL;
    reply(slcan, &word, 1);
}

/* ----------------------------------------------------------------------------------------------- in -- */

/* A line without its CR. */
typedef struct {
    const uint8_t *text;
    uint32_t length;
} line_t;

/* Capital and small letters alike. */
static uint32_t digit_value(uint8_t character)
{
    const uint32_t decimal = (uint32_t)character - '0'; /* below '0' it wraps to a large number */
    if (decimal <= 9u) {
        return decimal;
    }
    const uint32_t letter = ((uint32_t)character | 0x20u) - 'a';
    return letter <= 5u ? letter + 10u : NOT_A_DIGIT;
}

/* Reads hexadecimal digits, the first one the highest; false: one of them is none.
 *   count: [1, 8] */
static bool read_hex(const uint8_t *text, uint32_t count, uint32_t *value)
{
    uint32_t sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t digit = digit_value(text[i]);
        if (digit == NOT_A_DIGIT) {
            return false;
        }
        sum = sum << 4 | digit;
    }
    *value = sum;
    return true;
}

/* tiiildd... or Tiiiiiiiildd..., r and R without data. false: the line is none of these. */
static bool parse(const line_t *line, brace_can_frame_t *frame)
{
    const uint8_t kind = line->text[0];
    const bool is_extended = kind == 'T' || kind == 'R', has_data = kind == 't' || kind == 'T';
    const uint32_t id_digits = is_extended ? 8u : 3u, head = 2u + id_digits;
    uint32_t id, value;
    if (line->length < head || !read_hex(&line->text[1], id_digits, &id) || (!is_extended && id > 0x7ffu)) {
        return false;
    }
    const uint32_t length = (uint32_t)line->text[head - 1u] - '0';
    if (length > DATA_MOST || line->length != head + (has_data ? 2u * length : 0u)) {
        return false;
    }
    for (uint32_t i = 0; has_data && i < length; i++) {
        if (!read_hex(&line->text[head + 2u * i], 2, &value)) {
            return false;
        }
        frame->data[i] = (uint8_t)value;
    }
    frame->id = id;
    frame->length = (uint8_t)length;
    frame->fd = false;
    return true;
}

/* A letter and one digit, no more. */
static bool has_digit_up_to(const line_t *line, uint8_t highest)
{
    return line->length == 2u && line->text[1] >= '0' && line->text[1] <= highest;
}

/* Opens, closes and sets up the channel. returns whether this was possible */
static bool obey_channel(slcan_t *slcan, const line_t *line)
{
    const bool stands_alone = line->length == 1u;
    switch (line->text[0]) {
    case 'S': return !slcan->is_open && has_digit_up_to(line, '8');
    case 's': return !slcan->is_open;
    case 'Z': return !slcan->is_open && has_digit_up_to(line, '0');
    case 'O':
    case 'L':
        if (!stands_alone || slcan->is_open) {
            return false;
        }
        slcan->is_open = true;
        slcan->is_listen_only = line->text[0] == 'L';
        return true;
    case 'C':
        slcan->was_closed = slcan->was_closed || (slcan->is_open && stands_alone);
        slcan->is_open = slcan->is_open && !stands_alone;
        return stands_alone;
    default: return false;
    }
}

/* A frame comes by an open channel only, but an urgent one always does. */
static bool takes_frame(const slcan_t *slcan, const line_t *line, brace_can_frame_t *frame)
{
    return parse(line, frame) &&
           ((slcan->is_open && !slcan->is_listen_only) || (line->text[0] == 't' && frame->id == slcan->urgent_id));
}

/* A line has come to its end. returns whether it is a frame for the node */
static bool obey(slcan_t *slcan, const line_t *line, brace_can_frame_t *frame)
{
    if (line->length == 0u) { /* whoever connects clears the line with a few of them */
        reply_yes_or_no(slcan, true);
        return false;
    }
    const uint8_t kind = line->text[0];
    switch (kind) {
    case 'V': reply(slcan, "V1013\r", 6); return false;
    case 'v': reply(slcan, "v0100\r", 6); return false;
    case 'N': reply(slcan, "NBRC1\r", 6); return false;
    case 'F': reply(slcan, slcan->is_open ? "F00\r" : "\a", slcan->is_open ? 4u : 1u); return false;
    case 't':
    case 'T':
    case 'r':
    case 'R':
        if (!takes_frame(slcan, line, frame)) {
            reply_yes_or_no(slcan, false);
            return false;
        }
        reply(slcan, kind == 't' || kind == 'r' ? "z\r" : "Z\r", 2);
        return kind == 't';
    default: reply_yes_or_no(slcan, obey_channel(slcan, line)); return false;
    }
}

/* returns whether bytes have come */
static bool read_port(slcan_t *slcan, const brace_hal_t *hal)
{
    const uint32_t room = (uint32_t)SLCAN_IN_BYTES - slcan->in_count;
    const int32_t read = hal->serial_read(hal->context, BRACE_SERIAL_SLCAN, &slcan->in[slcan->in_count], room);
    const bool has_come = read > 0 && read <= (int32_t)room;
    slcan->in_count = (uint8_t)(slcan->in_count + (has_come ? read : 0));
    return has_come;
}

/* Where the first CR stands; slcan->in_count: there is none. */
static uint32_t end_of_line(const slcan_t *slcan)
{
    const uint8_t *end = memchr(slcan->in, CR, slcan->in_count);
    return end != NULL ? (uint32_t)(end - slcan->in) : slcan->in_count;
}

static void drop(slcan_t *slcan, uint32_t count)
{
    slcan->in_count = (uint8_t)(slcan->in_count - count);
    memmove(slcan->in, slcan->in + count, slcan->in_count);
}

/* Obeys the first line, if its end has come, and drops it.
 *   is_frame (out): it is a frame for the node
 * returns whether its end has come */
static bool take_line(slcan_t *slcan, brace_can_frame_t *frame, bool *is_frame)
{
    const uint32_t end = end_of_line(slcan);
    if (end == slcan->in_count) {
        slcan->skips = slcan->skips || end == (uint32_t)SLCAN_IN_BYTES;
        slcan->in_count = slcan->skips ? 0u : slcan->in_count;
        return false;
    }
    if (slcan->skips) {
        reply_yes_or_no(slcan, false);
        slcan->skips = false;
    } else {
        /* of a host that ends its lines with CR and LF */
        const uint32_t start = end > 0u && slcan->in[0] == '\n' ? 1u : 0u;
        const line_t line = {&slcan->in[start], end - start};
        *is_frame = obey(slcan, &line, frame);
    }
    drop(slcan, end + 1u);
    return true;
}

bool slcan_receive(slcan_t *slcan, const brace_hal_t *hal, brace_can_frame_t *frame)
{
    bool is_frame = false;
    if (!slcan->is_fitted) {
        return false;
    }
    for (uint32_t i = 0; i < LINES_MOST && !is_frame; i++) {
        if (!take_line(slcan, frame, &is_frame) && !read_port(slcan, hal)) {
            break;
        }
    }
    return is_frame;
}
