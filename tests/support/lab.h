/* lab.h - colours as eyes see them: CIE L*a*b* (D65), and eyes without one kind of cone. */
#ifndef FFD_TESTS_LAB_H
#define FFD_TESTS_LAB_H

#include <math.h>
#include <stdint.h>

typedef enum vision { VISION_NORMAL, VISION_PROTANOPIA, VISION_DEUTERANOPIA, VISIONS } vision;

static inline double lab_linear(uint8_t byte)
{
    const double x = byte / 255.0;
    return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

static inline double lab_root(double x)
{
    return x > 216.0 / 24389 ? cbrt(x) : (24389.0 / 27 * x + 16) / 116;
}

/* Converts an sRGB colour. The matrices of missing cones: Machado, Oliveira and Fernandes 2009, severity 1,
   for linear light. */
static inline void lab_of(const uint8_t color[3], vision by, double lab[3])
{
    static const double eyes[VISIONS][9] = {
        {1, 0, 0, 0, 1, 0, 0, 0, 1},
        {0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998},
        {0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881}};
    static const double xyz[9] = {0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522,
                                  0.0721750, 0.0193339, 0.1191920, 0.9503041};
    static const double white[3] = {0.95047, 1, 1.08883};
    double seen[3], root[3];
    for (int r = 0; r < 3; r++) {
        const double *const m = eyes[by] + 3 * r;
        const double light =
            m[0] * lab_linear(color[0]) + m[1] * lab_linear(color[1]) + m[2] * lab_linear(color[2]);
        seen[r] = light < 0 ? 0 : light > 1 ? 1 : light;
    }
    for (int r = 0; r < 3; r++)
        root[r] =
            lab_root((xyz[3 * r] * seen[0] + xyz[3 * r + 1] * seen[1] + xyz[3 * r + 2] * seen[2]) / white[r]);
    lab[0] = 116 * root[1] - 16;
    lab[1] = 500 * (root[0] - root[1]);
    lab[2] = 200 * (root[1] - root[2]);
}

/* Returns the distance of two colours (CIE 1976) to such an eye. */
static inline double lab_distance_by(const uint8_t a[3], const uint8_t b[3], vision by)
{
    double one[3], other[3];
    lab_of(a, by, one);
    lab_of(b, by, other);
    return sqrt((one[0] - other[0]) * (one[0] - other[0]) + (one[1] - other[1]) * (one[1] - other[1]) +
                (one[2] - other[2]) * (one[2] - other[2]));
}

static inline double lab_distance(const uint8_t a[3], const uint8_t b[3])
{
    return lab_distance_by(a, b, VISION_NORMAL);
}

#endif
