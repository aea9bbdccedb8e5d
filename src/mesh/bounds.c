#include "mesh/bounds.h"

void ffd_bounds_json(json_text *json, const char *key, const ffd_bounds *box)
{
    if (box->min[0] > box->max[0]) {
        ffd_json_null(json, key);
        return;
    }
    ffd_json_object(json, key, false);
    ffd_json_vector(json, "min", box->min, 3);
    ffd_json_vector(json, "max", box->max, 3);
    ffd_json_end(json, '}');
}
