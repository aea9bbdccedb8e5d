#include "picture/stripes.h"

bool ffd_stripes_second(picture_stripes stripes, int32_t period, int64_t x, int64_t y)
{
    if (stripes == STRIPES_NONE || period < 2)
        return false;
    const int64_t along = stripes == STRIPES_RISING ? x + y : x - y, rest = along % period;
    return 2 * (rest < 0 ? rest + period : rest) >= period;
}
