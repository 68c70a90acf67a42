#include <fcntl.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "posix_door.h"
#include "posix_io.h"

enum { SYNCED_BYTES = 4096 }; /* the part of a slot that holds the parameters */

int32_t brace_posix_nvm_open(brace_posix_nvm_t *nvm, const char *path, bool *is_new)
{
    nvm->file = -1;
    nvm->fails = nvm->forgets = false;
    memset(nvm->bytes, 0xff, sizeof nvm->bytes);
    if (is_new != NULL) {
        *is_new = true;
    }
    if (path == NULL) {
        return BRACE_POSIX_OK;
    }
    int file = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file < 0) {
        return io_status_of_errno();
    }
    struct stat about;
    int32_t status = BRACE_POSIX_OK;
    if (flock(file, LOCK_EX | LOCK_NB) != 0 || fstat(file, &about) != 0) {
        status = io_status_of_errno();
    } else if (about.st_size == 0) {
        if (pwrite(file, nvm->bytes, sizeof nvm->bytes, 0) != (ssize_t)sizeof nvm->bytes) {
            status = BRACE_POSIX_E_SYSTEM;
        }
    } else if (about.st_size != (off_t)sizeof nvm->bytes) {
        status = BRACE_POSIX_E_SIZE;
    } else if (pread(file, nvm->bytes, sizeof nvm->bytes, 0) != (ssize_t)sizeof nvm->bytes) {
        memset(nvm->bytes, 0xff, sizeof nvm->bytes);
        status = BRACE_POSIX_E_SYSTEM;
    }
    if (status != BRACE_POSIX_OK) {
        io_close(&file);
        return status;
    }
    nvm->file = file;
    for (uint32_t i = 0; is_new != NULL && *is_new && i < sizeof nvm->bytes; i++) {
        *is_new = ((const uint8_t *)nvm->bytes)[i] == 0xffu;
    }
    return BRACE_POSIX_OK;
}

void brace_posix_nvm_close(brace_posix_nvm_t *nvm)
{
    io_close(&nvm->file);
}

/* Writes memory to the file. For parameters the call returns only when the disk has them. The rest of a slot is written
 * while the limb works, which cannot wait for a disk: it survives the process, but not a loss of the computer's
 * power. */
static int32_t keep(brace_posix_nvm_t *nvm, uint32_t slot, uint32_t offset, uint32_t count)
{
    if (nvm->file < 0) {
        return BRACE_HAL_OK;
    }
    const off_t place = (off_t)slot * BRACE_POSIX_SLOT_BYTES + (off_t)offset;
    const bool kept = pwrite(nvm->file, &nvm->bytes[slot][offset], count, place) == (ssize_t)count &&
                      (offset >= SYNCED_BYTES || fdatasync(nvm->file) == 0);
    return kept ? BRACE_HAL_OK : BRACE_HAL_E_DEVICE;
}

static bool is_within(uint32_t slot, uint32_t offset, uint32_t count)
{
    return slot < BRACE_NVM_SLOT_COUNT && offset <= BRACE_POSIX_SLOT_BYTES && count <= BRACE_POSIX_SLOT_BYTES - offset;
}

int32_t door_nvm_read(void *context, uint32_t slot, uint32_t offset, uint8_t *bytes, uint32_t count)
{
    const brace_posix_nvm_t *nvm = &((brace_posix_t *)context)->nvm;
    if (!is_within(slot, offset, count)) {
        return BRACE_HAL_E_RANGE;
    }
    memcpy(bytes, &nvm->bytes[slot][offset], count);
    return BRACE_HAL_OK;
}

int32_t door_nvm_write(void *context, uint32_t slot, uint32_t offset, const uint8_t *bytes, uint32_t count)
{
    brace_posix_nvm_t *nvm = &((brace_posix_t *)context)->nvm;
    if (!is_within(slot, offset, count) || offset % BRACE_POSIX_WRITE_BYTES != 0u ||
        count % BRACE_POSIX_WRITE_BYTES != 0u) {
        return BRACE_HAL_E_RANGE;
    }
    if (nvm->fails) {
        return BRACE_HAL_E_DEVICE;
    }
    if (nvm->forgets) {
        return BRACE_HAL_OK;
    }
    for (uint32_t i = 0; i < count; i++) { /* as in flash: a write only turns ones to zeros */
        nvm->bytes[slot][offset + i] &= bytes[i];
    }
    return keep(nvm, slot, offset, count);
}

int32_t door_nvm_erase(void *context, uint32_t slot)
{
    brace_posix_nvm_t *nvm = &((brace_posix_t *)context)->nvm;
    if (slot >= BRACE_NVM_SLOT_COUNT) {
        return BRACE_HAL_E_RANGE;
    }
    if (nvm->fails) {
        return BRACE_HAL_E_DEVICE;
    }
    if (nvm->forgets) {
        return BRACE_HAL_OK;
    }
    memset(nvm->bytes[slot], 0xff, BRACE_POSIX_SLOT_BYTES);
    return keep(nvm, slot, 0, BRACE_POSIX_SLOT_BYTES);
}
