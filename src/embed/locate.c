/* locate.c - ffd_locator_locate (ffd/embedding.h), which supports callers with a smaller ffd_location. */
#include "base/struct_size.h"
#include "embed/locator.h"
#include <string.h>

/* The number of locations that are computed at a time if those of the caller are smaller. */
#define AT_ONCE 256

static ffd_status find_shorter(const ffd_locator *locator, const double *xyz, size_t count,
                               const ffd_border_allowance *allowance, unsigned char *callers, size_t size,
                               ffd_error *error)
{
    ffd_location own[AT_ONCE];
    for (size_t first = 0; first < count; first += AT_ONCE) {
        const size_t some = count - first < AT_ONCE ? count - first : AT_ONCE;
        ffd_border_allowance theirs;
        if (allowance) {
            theirs = *allowance;
            theirs.rounding = allowance->rounding ? allowance->rounding + 3 * first : NULL;
        }
        TRY(ffd_locator_find_near(locator, xyz + 3 * first, some, allowance ? &theirs : NULL, own, error));
        for (size_t i = 0; i < some; i++)
            memcpy(callers + size * (first + i), &own[i], size);
    }
    return FFD_OK;
}

ffd_status ffd_locator_locate(const ffd_locator *locator, const double *xyz, size_t count,
                              const ffd_border_allowance *callers_allowance, ffd_location *locations,
                              size_t location_size, ffd_error *error)
{
    ffd_border_allowance allowance = {.snap = 0};
    if (!location_size || location_size % _Alignof(ffd_location) || location_size > sizeof *locations)
        return ffd_fail(
            error, FFD_E_ARGUMENT,
            "ffd_location has %zu bytes, and this library knows %zu: if the caller's has more, it is "
            "from a newer header",
            location_size, sizeof *locations);
    if (callers_allowance)
        TRY(ffd_struct_take(&allowance, sizeof allowance, callers_allowance, "ffd_border_allowance", error));
    const ffd_border_allowance *const own = callers_allowance ? &allowance : NULL;
    return location_size == sizeof *locations
               ? ffd_locator_find_near(locator, xyz, count, own, locations, error)
               : find_shorter(locator, xyz, count, own, (unsigned char *)locations, location_size, error);
}
