#include "wire/modbus/identity.h"

#include <stdbool.h>
#include <string.h>

#include "brace/can_messages.h"
#include "wire/version.h"

enum {
    SERVER_ID = 0xb2,
    RUNS = 0xff,
    READ_DEVICE_ID = 14,
    OBJECTS = 3,
    CONFORMITY = 0x81 /* basic, stream and single */
};

static const char name[] = "Brace";
static const char code[] = "limb controller";

/* Writes the version as text; major, minor and patch are each below 100. returns how many characters. */
static uint32_t put_version(uint8_t *text)
{
    static const uint8_t part[3] = {BRACE_FIRMWARE_MAJOR, BRACE_FIRMWARE_MINOR, BRACE_FIRMWARE_PATCH};
    uint32_t count = 0;
    for (uint32_t i = 0; i < 3u; i++) {
        if (part[i] >= 10u) {
            text[count++] = (uint8_t)('0' + part[i] / 10u % 10u);
        }
        text[count++] = (uint8_t)('0' + part[i] % 10u);
        if (i < 2u) {
            text[count++] = '.';
        }
    }
    return count;
}

static uint32_t put_hex(uint8_t *text, uint32_t value)
{
    for (uint32_t i = 0; i < 8u; i++) {
        text[i] = (uint8_t) "0123456789abcdef"[value >> (28u - 4u * i) & 0xfu];
    }
    return 8;
}

static uint32_t put_text(uint8_t *bytes, const char *text, uint32_t count)
{
    memcpy(bytes, text, count);
    return count;
}

modbus_exception_t modbus_server_id(uint8_t *pdu, uint32_t length, uint32_t *answer)
{
    static const char words[] = " dictionary ";
    if (length != 1u) {
        return MODBUS_E_VALUE;
    }
    uint32_t end = 4;
    pdu[2] = SERVER_ID;
    pdu[3] = RUNS;
    end += put_text(pdu + end, name, sizeof name - 1u);
    pdu[end++] = ' ';
    end += put_version(pdu + end);
    end += put_text(pdu + end, words, sizeof words - 1u);
    end += put_hex(pdu + end, BRACE_DICTIONARY_HASH);
    pdu[1] = (uint8_t)(end - 2u);
    *answer = end;
    return MODBUS_FINE;
}

static uint32_t put_object(uint8_t *bytes, uint32_t object)
{
    uint32_t count;
    switch (object) {
    case 0: count = put_text(bytes + 2, name, sizeof name - 1u); break;
    case 1: count = put_text(bytes + 2, code, sizeof code - 1u); break;
    default: count = put_version(bytes + 2); break;
    }
    bytes[0] = (uint8_t)object;
    bytes[1] = (uint8_t)count;
    return count + 2u;
}

modbus_exception_t modbus_device_id(uint8_t *pdu, uint32_t length, uint32_t *answer)
{
    if (length < 2u || pdu[1] != READ_DEVICE_ID) {
        return MODBUS_E_FUNCTION;
    }
    if (length != 4u || pdu[2] < 1u || pdu[2] > 4u) {
        return MODBUS_E_VALUE;
    }
    const bool single = pdu[2] == 4u;
    uint32_t object = pdu[3];
    if (object >= OBJECTS && single) {
        return MODBUS_E_ADDRESS;
    }
    object = object < OBJECTS ? object : 0u; /* a stream that asks beyond the last object begins anew */
    const uint32_t last = single ? object : OBJECTS - 1u;
    uint32_t end = 7;
    pdu[3] = CONFORMITY;
    pdu[4] = pdu[5] = 0; /* no further answer follows */
    pdu[6] = (uint8_t)(last - object + 1u);
    for (; object <= last; object++) { /* at most OBJECTS */
        end += put_object(pdu + end, object);
    }
    *answer = end;
    return MODBUS_FINE;
}
