/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "ice/slab_fill.h"
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/pi.h"

/* Heights within this fraction of D are one layer; distances within it of D are D. */
#define SAME_LAYER 0.2
#define SAME_DISTANCE 0.01

/* phi outside these is another sheet than the one meant. */
#define LEAST_FILL 0.2
#define MOST_FILL 1.1

enum { LAYERS_MAX = 64 };

/* Heights of the layers, ascending; their number, or -1 if there are more than LAYERS_MAX. */
static int find_layers(int32_t n, const fl_vec3 *x, double apart, double *z)
{
    int layers = 0;
    for (int32_t i = 0; i < n; i++) {
        int k = 0;
        while (k < layers && fabs(z[k] - x[i].z) > apart) k++;
        if (k < layers) continue;
        if (layers == LAYERS_MAX) return -1;
        z[layers++] = x[i].z;
    }
    for (int a = 1; a < layers; a++)
        for (int b = a; b > 0 && z[b] < z[b - 1]; b--) {
            const double t = z[b];
            z[b] = z[b - 1], z[b - 1] = t;
        }
    return layers;
}

/* Number of neighbours at the distance D, in the layer at z, of the sphere nearest to the middle. */
static int count_neighbours(int32_t n, const fl_vec3 *x, double D, double z)
{
    fl_vec3 middle = v3(0, 0, 0);
    int32_t at = -1, count = 0;
    double least = INFINITY;
    for (int32_t i = 0; i < n; i++) middle = v3_madd(middle, 1.0 / n, x[i]);
    for (int32_t i = 0; i < n; i++) {
        const double dx = x[i].x - middle.x, dy = x[i].y - middle.y, d2 = dx * dx + dy * dy;
        if (fabs(x[i].z - z) < SAME_LAYER * D && d2 < least) least = d2, at = i;
    }
    for (int32_t i = 0; i < n; i++)
        count += i != at && fabs(x[i].z - z) < SAME_LAYER * D &&
                 fabs(v3_norm(v3_sub(x[i], x[at])) - D) < SAME_DISTANCE * D;
    return count;
}

int fl_slab_fill(int32_t n, const fl_vec3 *x, double radius, double h, double *phi, fl_err *err)
{
    const double D = 2.0 * radius;
    double z[LAYERS_MAX];
    const int layers = find_layers(n, x, SAME_LAYER * D, z);
    if (n < 1 || layers < 1)
        return fl_fail(err, FL_INPUT, "ice.slab: the spheres do not lie in layers, which a slab has");
    const double area = count_neighbours(n, x, D, z[0]) > 4 ? sqrt(0.75) * D * D : D * D,
                 fill = layers * (PI * D * D * D / 6.0) / (area * h);
    if (!(fill >= LEAST_FILL && fill <= MOST_FILL))
        return fl_fail(err, FL_INPUT,
                       "ice.slab: %d layers of spheres of %.4g m would fill %.3g of a slab of %.4g m, %.1f to "
                       "%.1f are expected",
                       layers, D, fill, h, LEAST_FILL, MOST_FILL);
    *phi = fill;
    return 0;
}
