#include "mesh/memory_budget.h"

#define MEGABYTE ((uint64_t)1000000)
#define LEAST (100 * MEGABYTE)
#define BYTES_PER_BYTE 20

/* Of the program itself, before it has read anything. */
#define PROGRAM (16 * MEGABYTE)

/* Of a file's byte: itself, and of vectors in six characters each (0 0 0), or 12 bytes, twice 24. */
#define KEPT_OF_TEXT 9
#define KEPT_OF_FLOATS 5

static uint64_t add(uint64_t a, uint64_t b, uint64_t times)
{
    return times && b > (UINT64_MAX - a) / times ? UINT64_MAX : a + b * times;
}

uint64_t ffd_room_most(const mesh_room *room)
{
    return room->asked > room->most ? room->asked : room->most;
}

mesh_room ffd_room_make(uint64_t asked)
{
    return (mesh_room){.most = LEAST, .taken = PROGRAM, .asked = asked};
}

void ffd_room_add_file(mesh_room *room, uint64_t size, uint64_t kept_per_byte)
{
    if (!room->is_shared)
        room->most = add(room->most, size, BYTES_PER_BYTE);
    room->taken = add(room->taken, size, kept_per_byte);
}

mesh_room ffd_room_of_file(uint64_t size, bool text, uint64_t asked)
{
    mesh_room room = ffd_room_make(asked);
    ffd_room_add_file(&room, size, text ? KEPT_OF_TEXT : KEPT_OF_FLOATS);
    return room;
}

uint64_t ffd_room_left(const mesh_room *room)
{
    const uint64_t most = ffd_room_most(room);
    return most > room->taken ? most - room->taken : 0;
}

ffd_status ffd_room_check(const mesh_room *room, uint64_t count, uint64_t size, ffd_error *error)
{
    if (size == 0 || count <= ffd_room_left(room) / size)
        return FFD_OK;
    return ffd_fail(error, FFD_E_LIMIT,
                    "needs more than the %llu MB of memory allowed (--memory raises this)",
                    (unsigned long long)(ffd_room_most(room) / MEGABYTE));
}

ffd_status ffd_room_take(mesh_room *room, uint64_t count, uint64_t size, ffd_error *error)
{
    const ffd_status status = ffd_room_check(room, count, size, error);
    if (status == FFD_OK)
        room->taken += count * size; /* no more than what was left */
    return status;
}

void ffd_room_return(mesh_room *room, uint64_t count, uint64_t size)
{
    room->taken -= count * size;
}

int ffd_room_threads(const mesh_room *room, int threads, uint64_t size)
{
    const uint64_t most = ffd_room_left(room) / size;
    return threads <= 1 || most <= 1 ? 1 : most < (uint64_t)threads ? (int)most : threads;
}
