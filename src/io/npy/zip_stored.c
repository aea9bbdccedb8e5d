#include "io/npy/zip_stored.h"
#include "base/crc.h"
#include "base/little_endian.h"
#include <stdio.h>
#include <string.h>

enum {
    LOCAL_HEADER = 0x04034b50,
    DESCRIPTOR = 0x08074b50,
    CENTRAL_HEADER = 0x02014b50,
    END_OF_CENTRAL = 0x06054b50,
    END_OF_CENTRAL_64 = 0x06064b50,
    LOCATOR_64 = 0x07064b50
};
#define VERSION_64 45
#define FLAG_DESCRIPTOR 8
#define DATE_1980 0x21 /* 1 January 1980: the bytes of an archive do not depend on the time */
#define FULL_32 UINT32_MAX

/* A record under construction. */
typedef struct record {
    unsigned char bytes[160];
    size_t size;
} record;

static void put16(record *r, unsigned value)
{
    r->bytes[r->size++] = (unsigned char)(value & 0xff);
    r->bytes[r->size++] = (unsigned char)(value >> 8 & 0xff);
}

static void put32(record *r, uint32_t value)
{
    put16(r, value & 0xffff);
    put16(r, value >> 16);
}

static void put64(record *r, uint64_t value)
{
    store_u64(r->bytes + r->size, value);
    r->size += 8;
}

static void put_name(record *r, const char *name)
{
    const size_t length = strlen(name);
    memcpy(r->bytes + r->size, name, length);
    r->size += length;
}

static ffd_status write_record(zip_writer *zip, const record *r, ffd_error *error)
{
    zip->offset += r->size;
    return ffd_output_write(zip->output, r->bytes, r->size, error);
}

void ffd_zip_begin(zip_writer *zip, file_output *output)
{
    *zip = (zip_writer){.output = output};
}

/* The size is always in the ZIP64 extra field: readers take it from there. */
ffd_status ffd_zip_member(zip_writer *zip, const char *name, uint64_t size, ffd_error *error)
{
    zip_member *const member = &zip->members[zip->count++];
    record r = {.size = 0};
    *member = (zip_member){.size = size, .offset = zip->offset};
    snprintf(member->name, sizeof member->name, "%s", name);
    put32(&r, LOCAL_HEADER);
    put16(&r, VERSION_64);
    put16(&r, FLAG_DESCRIPTOR);
    put16(&r, 0); /* stored */
    put16(&r, 0);
    put16(&r, DATE_1980);
    put32(&r, 0); /* the checksum follows */
    put32(&r, FULL_32);
    put32(&r, FULL_32);
    put16(&r, (unsigned)strlen(member->name));
    put16(&r, 20);
    put_name(&r, member->name);
    put16(&r, 1);
    put16(&r, 16);
    put64(&r, size);
    put64(&r, size);
    return write_record(zip, &r, error);
}

ffd_status ffd_zip_write(zip_writer *zip, const void *bytes, size_t size, ffd_error *error)
{
    zip_member *const member = &zip->members[zip->count - 1];
    member->crc = ffd_crc(member->crc, bytes, size);
    zip->offset += size;
    return ffd_output_write(zip->output, bytes, size, error);
}

ffd_status ffd_zip_member_end(zip_writer *zip, ffd_error *error)
{
    const zip_member *const member = &zip->members[zip->count - 1];
    record r = {.size = 0};
    put32(&r, DESCRIPTOR);
    put32(&r, member->crc);
    put64(&r, member->size);
    put64(&r, member->size);
    return write_record(zip, &r, error);
}

static ffd_status write_central(zip_writer *zip, const zip_member *member, ffd_error *error)
{
    record r = {.size = 0};
    put32(&r, CENTRAL_HEADER);
    put16(&r, VERSION_64);
    put16(&r, VERSION_64);
    put16(&r, FLAG_DESCRIPTOR);
    put16(&r, 0);
    put16(&r, 0);
    put16(&r, DATE_1980);
    put32(&r, member->crc);
    put32(&r, FULL_32);
    put32(&r, FULL_32);
    put16(&r, (unsigned)strlen(member->name));
    put16(&r, 28);
    put16(&r, 0); /* comment */
    put16(&r, 0); /* disk */
    put16(&r, 0); /* internal and external attributes */
    put32(&r, 0);
    put32(&r, FULL_32);
    put_name(&r, member->name);
    put16(&r, 1);
    put16(&r, 24);
    put64(&r, member->size);
    put64(&r, member->size);
    put64(&r, member->offset);
    return write_record(zip, &r, error);
}

ffd_status ffd_zip_end(zip_writer *zip, ffd_error *error)
{
    const uint64_t start = zip->offset;
    for (size_t i = 0; i < zip->count; i++)
        TRY(write_central(zip, &zip->members[i], error));
    const uint64_t end = zip->offset;
    record r = {.size = 0};
    put32(&r, END_OF_CENTRAL_64);
    put64(&r, 44);
    put16(&r, VERSION_64);
    put16(&r, VERSION_64);
    put32(&r, 0);
    put32(&r, 0);
    put64(&r, zip->count);
    put64(&r, zip->count);
    put64(&r, end - start);
    put64(&r, start);
    put32(&r, LOCATOR_64);
    put32(&r, 0);
    put64(&r, end);
    put32(&r, 1);
    put32(&r, END_OF_CENTRAL);
    put16(&r, 0);
    put16(&r, 0);
    put16(&r, (unsigned)zip->count);
    put16(&r, (unsigned)zip->count);
    put32(&r, FULL_32);
    put32(&r, FULL_32);
    put16(&r, 0);
    return write_record(zip, &r, error);
}
