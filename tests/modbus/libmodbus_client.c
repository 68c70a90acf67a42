/* libmodbus at the end of a pipe: connects (tcp HOST PORT UNIT, or rtu DEVICE BAUD UNIT), then for each line of input
 * one request, one line of output.
 *   r3 ADDRESS COUNT | r4 ADDRESS COUNT -> ok VALUE...   w ADDRESS VALUE... (function 16)   w6 ADDRESS VALUE -> ok
 *   id -> ok BYTE...   refused: exception NUMBER   else: failed WORDS
 */
#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <modbus.h>

enum { VALUES = 130 };

static void refused(void)
{
    if (errno > MODBUS_ENOBASE && errno < MODBUS_ENOBASE + MODBUS_EXCEPTION_MAX) {
        printf("exception %d\n", errno - MODBUS_ENOBASE);
    } else {
        printf("failed %s\n", modbus_strerror(errno));
    }
}

static void print_values(const uint16_t *values, int count)
{
    printf("ok");
    for (int i = 0; i < count; i++) {
        printf(" %u", values[i]);
    }
    printf("\n");
}

static void identify(modbus_t *bus)
{
    uint8_t bytes[256];
    const int count = modbus_report_slave_id(bus, sizeof bytes, bytes);
    uint16_t values[256];
    for (int i = 0; i < count; i++) {
        values[i] = bytes[i];
    }
    count < 0 ? refused() : print_values(values, count);
}

static void request(modbus_t *bus, char *line)
{
    uint16_t values[VALUES] = {0};
    int numbers[VALUES], count = 0;
    const char *verb = strtok(line, " \n");
    for (const char *word = strtok(NULL, " \n"); word != NULL && count < VALUES; word = strtok(NULL, " \n")) {
        numbers[count++] = atoi(word);
    }
    int done = -1, wanted = 0;
    if (strcmp(verb, "id") == 0) {
        identify(bus);
        return;
    }
    if (verb[0] == 'r') {
        wanted = numbers[1];
        done = verb[1] == '4' ? modbus_read_input_registers(bus, numbers[0], wanted, values)
                              : modbus_read_registers(bus, numbers[0], wanted, values);
    } else if (strcmp(verb, "w6") == 0) {
        done = modbus_write_register(bus, numbers[0], (uint16_t)numbers[1]);
    } else {
        for (int i = 1; i < count; i++) {
            values[i - 1] = (uint16_t)numbers[i];
        }
        done = modbus_write_registers(bus, numbers[0], count - 1, values);
    }
    done < 0 ? refused() : print_values(values, wanted);
}

int main(int argc, char **argv)
{
    char line[4096];
    modbus_t *bus = argc != 5                     ? NULL
                    : strcmp(argv[1], "tcp") == 0 ? modbus_new_tcp(argv[2], atoi(argv[3]))
                                                  : modbus_new_rtu(argv[2], atoi(argv[3]), 'N', 8, 1);
    if (bus == NULL || modbus_set_slave(bus, atoi(argv[4])) != 0 || modbus_connect(bus) != 0) {
        printf("failed %s\n", modbus_strerror(errno));
        return 4;
    }
    modbus_set_response_timeout(bus, 10, 0); /* an emulated board on a busy machine takes one */
    modbus_set_byte_timeout(bus, 5, 0);
    setvbuf(stdout, NULL, _IOLBF, 0);
    while (fgets(line, sizeof line, stdin) != NULL) {
        request(bus, line);
    }
    modbus_close(bus);
    modbus_free(bus);
    return 0;
}
