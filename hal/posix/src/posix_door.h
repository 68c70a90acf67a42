/* The door's entries, grouped by the file that implements them. */
#ifndef POSIX_DOOR_H
#define POSIX_DOOR_H

#include "brace_hal_posix.h"

int32_t door_nvm_read(void *context, uint32_t slot, uint32_t offset, uint8_t *bytes, uint32_t count);
int32_t door_nvm_write(void *context, uint32_t slot, uint32_t offset, const uint8_t *bytes, uint32_t count);
int32_t door_nvm_erase(void *context, uint32_t slot);

int32_t door_can_setup(void *context, const brace_can_setup_t *setup);
int32_t door_can_send(void *context, const brace_can_frame_t *frame);
int32_t door_can_receive(void *context, brace_can_frame_t *frame);
int32_t door_can_health(void *context, brace_can_health_t *health);
int32_t door_can_recover(void *context);

int32_t stream_setup(brace_posix_stream_t *stream, uint32_t baud, brace_parity_t parity);
void stream_poll(brace_posix_stream_t *stream);

int32_t posix_modbus_write_to(brace_posix_modbus_t *modbus, uint32_t serial, const uint8_t *bytes, uint32_t count);
int32_t posix_modbus_read(brace_posix_modbus_t *modbus, uint8_t *bytes, uint32_t room);
void posix_modbus_poll(brace_posix_modbus_t *modbus);

#endif
