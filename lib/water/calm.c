/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <assert.h>
#include <stddef.h>
#include "water/calm.h"

/* decay() of sea.c, where nothing is held and no water moved along, by the surface that the fluid meets,
 * r_eff, and its velocity; what it does is added to work[], times sign. */
FL_WIDE_VERSIONS static void decay(fl_few *restrict a, const fl_fluid *fluid, const double *restrict surface,
                                   const double *restrict reach, double (*restrict c)[FL_FEW],
                                   const double *restrict held, double sign, double *restrict work)
{
    const int turns = fluid->moment > 0.0;
#pragma omp simd
    for (int32_t i = 0; i < a->lanes; i++) {
        const double h = a->h[i], m = a->m[i], vx = a->v[0][i], vy = a->v[1][i], vz = a->v[2][i],
                     wx = a->w[0][i], wy = a->w[1][i], wz = a->w[2][i], Lx = a->L[0][i], Ly = a->L[1][i],
                     Lz = a->L[2][i], area = surface[i], r = reach[i];
        const double turning = wx * Lx + wy * Ly + wz * Lz, spin2 = wx * wx + wy * wy + wz * wz;
        const double before = 0.5 * (m * (vx * vx + vy * vy + vz * vz) + turning) - held[i];
        const double cx = c[0][i], cy = c[1][i], cz = c[2][i];
        const double ux = vx - cx, uy = vy - cy, uz = vz - cz, speed = sqrt(ux * ux + uy * uy + uz * uz);
        const double slow = fl_drag_factor(m, fl_drag_of_force(fluid, area), speed, h);
        const int spins = turns && turning > 0.0;
        const double calm =
            fl_drag_factor(spins ? turning : 1.0, fl_drag_of_moment(fluid, area, r) * spin2, sqrt(spin2), h);
        const int meets = area > 0.0;
        const double stays = meets && spins ? calm : 1.0;
        const double px = meets ? cx + slow * ux : vx, py = meets ? cy + slow * uy : vy,
                     pz = meets ? cz + slow * uz : vz;
        const double lx = stays * Lx, ly = stays * Ly, lz = stays * Lz, sx = stays * wx, sy = stays * wy,
                     sz = stays * wz;
        const double after =
            0.5 * (m * (px * px + py * py + pz * pz) + (sx * lx + sy * ly + sz * lz)) - held[i];
        a->v[0][i] = px, a->v[1][i] = py, a->v[2][i] = pz;
        a->L[0][i] = lx, a->L[1][i] = ly, a->L[2][i] = lz;
        a->w[0][i] = sx, a->w[1][i] = sy, a->w[2][i] = sz;
        work[i] += sign * (after - before);
    }
}

FL_WIDE_VERSIONS static void alike(double (*restrict c)[FL_FEW], fl_vec3 u, int32_t n)
{
#pragma omp simd
    for (int32_t i = 0; i < n; i++) c[0][i] = u.x, c[1][i] = u.y, c[2][i] = u.z;
}

FL_WIDE_VERSIONS static int meets(const double *restrict area, int32_t n)
{
    double many = 0.0;
#pragma omp simd reduction(+ : many)
    for (int32_t i = 0; i < n; i++) many += area[i] > 0.0 ? 1.0 : 0.0;
    return many > 0.0;
}

/* By what the fluid meets of each, and its velocity there. */
static void decay_all(fl_few *a, const fl_sea *s, const fl_bodies *b, const fl_fluid *fluid,
                      const double *surface, double (*c)[FL_FEW], double sign, double *work)
{
    _Alignas(64) double reach[FL_FEW], held[FL_FEW], done[FL_FEW];
    double *const sum = fl_few_see(a, work, done);
    decay(a, fluid, surface, fl_few_see(a, s->reach, reach), c, fl_few_see(a, b->held, held), sign, sum);
    fl_few_keep(a, work, sum);
}

static void water(fl_sea *s, const fl_bodies *b, fl_few *a)
{
    _Alignas(64) double c[3][FL_FEW], room[FL_FEW];
    const double *const wetted = fl_few_see(a, s->wetted, room);
    if (!(wetted[0] > 0.0) && !meets(wetted, a->lanes)) return;
    if (!s->flow) alike(c, s->current.velocity, a->lanes);
    for (int32_t k = 0; k < a->lanes && s->flow; k++) {
        const fl_vec3 u = s->flow[a->at[k]];
        c[0][k] = u.x, c[1][k] = u.y, c[2][k] = u.z;
    }
    decay_all(a, s, b, &s->sea, wetted, c, -1.0, s->drained);
}

static void wind(fl_sea *s, const fl_bodies *b, fl_few *a)
{
    _Alignas(64) double c[3][FL_FEW], dry[FL_FEW];
    alike(c, s->breeze, a->lanes);
    for (int32_t k = 0; k < a->lanes; k++)
        dry[k] = s->hull[a->at[k]].surface - (s->water ? s->wetted[a->at[k]] : 0.0);
    decay_all(a, s, b, &s->air, dry, c, 1.0, s->blown);
}

void fl_calm_drag(fl_sea *s, const fl_bodies *b, fl_few *a, int back)
{
    if (back && s->wind) wind(s, b, a);
    if (s->water) water(s, b, a);
    if (!back && s->wind) wind(s, b, a);
}

/* Right prisms, one array a number, in the order of fl_prism: read by that order. */
enum { AREA, O, A = O + 3, E = A + 3, Z0 = E + 3, Z1, JAA, JAB, JBB, ROUND, GA, GB, FAR2, NUMBERS };
static_assert(offsetof(fl_prism, o) == O * sizeof(double) && offsetof(fl_prism, e) == E * sizeof(double) &&
                  offsetof(fl_prism, jaa) == JAA * sizeof(double) &&
                  offsetof(fl_prism, far2) == FAR2 * sizeof(double),
              "as fl_prism has them");

typedef struct {
    _Alignas(64) double p[NUMBERS][FL_FEW];
    double level[FL_FEW];  /* of the water over the origin */
    double floats[FL_FEW]; /* out: 1 where all of it holds, 0 */
} prisms;

FL_FOUR_VERSIONS static void take_row(prisms *q, const fl_hull *h, int32_t lanes)
{
    const double *first = &h->prism.area;
    for (int32_t k = 0; k < lanes; k += FL_LANES) {
        for (int c = 0; c + 4 <= NUMBERS; c += 4) fl_few_split4(q->p + c, first + c, sizeof *h, k);
        /* the last four begin early, so as not to read beyond */
        fl_few_split4(q->p + NUMBERS - 4, first + NUMBERS - 4, sizeof *h, k);
    }
}

FL_FOUR_VERSIONS static void take_some(prisms *q, const fl_hull *h, const int32_t *at, int32_t lanes)
{
    const double *first = &h->prism.area;
    for (int32_t k = 0; k < lanes; k += FL_LANES) {
        for (int c = 0; c + 4 <= NUMBERS; c += 4) fl_few_pick4(q->p + c, first + c, sizeof *h, at, k);
        fl_few_pick4(q->p + NUMBERS - 4, first + NUMBERS - 4, sizeof *h, at, k);
    }
}

static void take(prisms *q, const fl_sea *s, const fl_few *a)
{
    if (a->row) take_row(q, &s->hull[a->at[0]], a->lanes);
    else take_some(q, s->hull, a->at, a->lanes);
}

/* fl_prism_wet(), fl_buoyancy_force() and what look_still() of sea.c makes of them; returns how many float as
 * prisms do. */
FL_WIDE_VERSIONS static double look(prisms *restrict q, fl_few *restrict a, double weight,
                                    const double *restrict reach, double *restrict wetted,
                                    double *restrict lift, double *restrict centre)
{
    double afloat = 0.0;
#pragma omp simd reduction(+ : afloat)
    for (int32_t i = 0; i < a->lanes; i++) {
        const double ux = a->R[6][i], uy = a->R[7][i], uz = a->R[8][i], level = q->level[i];
        const double ax = q->p[A][i], ay = q->p[A + 1][i], az = q->p[A + 2][i], ex = q->p[E][i],
                     ey = q->p[E + 1][i], ez = q->p[E + 2][i], ox = q->p[O][i], oy = q->p[O + 1][i],
                     oz = q->p[O + 2][i];
        const double bx = ey * az - ez * ay, by = ez * ax - ex * az, bz = ex * ay - ey * ax;
        const double area = q->p[AREA][i], jab = q->p[JAB][i];
        const double along = ux * ex + uy * ey + uz * ez;
        const int over = along < 0.0; /* turned over: seen along -e */
        const double ue = over ? -along : along, sign = over ? -1.0 : 1.0,
                     z0 = over ? -q->p[Z1][i] : q->p[Z0][i], z1 = over ? -q->p[Z0][i] : q->p[Z1][i];
        const double per_ue = 1.0 / (ue > 0.1 ? ue : 1.0);
        const double sa = -per_ue * (ux * ax + uy * ay + uz * az),
                     sb = -per_ue * (ux * bx + uy * by + uz * bz);
        const double zw = per_ue * (level - (ux * ox + uy * oy + uz * oz)), wet0 = zw - z0, dry0 = z1 - zw;
        const double least = wet0 < dry0 ? wet0 : dry0;
        const int floats = area > 0.0 && ue > 0.1 && level < reach[i] && level > -reach[i] && least > 0.0 &&
                           least * least > (sa * sa + sb * sb) * q->p[FAR2][i];
        const double ja = q->p[JAA][i] * sa + jab * sb, jb = jab * sa + q->p[JBB][i] * sb;
        const double volume = area * wet0, per = 1.0 / (floats ? volume : 1.0);
        const double mz = 0.5 * (area * wet0 * (zw + z0) + sa * ja + sb * jb);
        const double pa = per * ja, pb = per * jb, pe = sign * per * mz;
        const double cx = ox + pa * ax + pb * bx + pe * ex, cy = oy + pa * ay + pb * by + pe * ey,
                     cz = oz + pa * az + pb * bz + pe * ez;
        const double over_water = ux * cx + uy * cy + uz * cz - level, push = weight * volume;
        const double fx = push * ux, fy = push * uy, fz = push * uz;
        const double tx = cy * fz - cz * fy, ty = cz * fx - cx * fz, tz = cx * fy - cy * fx;
        const double one = floats ? 1.0 : 0.0;
        q->floats[i] = one;
        afloat += one;
        wetted[i] = area + q->p[ROUND][i] * (wet0 + sa * q->p[GA][i] + sb * q->p[GB][i]);
        lift[i] = push;
        centre[i] = over_water;
        a->f[0][i] += 0.0;
        a->f[1][i] += 0.0;
        a->f[2][i] += push;
        a->t[0][i] += a->R[0][i] * tx + a->R[1][i] * ty + a->R[2][i] * tz;
        a->t[1][i] += a->R[3][i] * tx + a->R[4][i] * ty + a->R[5][i] * tz;
        a->t[2][i] += a->R[6][i] * tx + a->R[7][i] * ty + a->R[8][i] * tz;
    }
    return afloat;
}

/* Where all of them are, told by their reach alone: -1 wholly out of the water, 1 wholly in, 0 neither. */
FL_WIDE_VERSIONS static int far(const double *restrict level, const double *restrict reach, int32_t n)
{
    double out = 0.0, in = 0.0;
#pragma omp simd reduction(+ : out, in)
    for (int32_t i = 0; i < n; i++) {
        out += level[i] <= -reach[i] ? 1.0 : 0.0;
        in += level[i] >= reach[i] ? 1.0 : 0.0;
    }
    return out == n ? -1 : in == n;
}

/* The same as look() makes where all of each is out of the water, but for the zeros that it adds; */
FL_WIDE_VERSIONS static void look_out(const double *restrict level, int32_t n, double *restrict wetted,
                                      double *restrict lift, double *restrict centre)
{
#pragma omp simd
    for (int32_t i = 0; i < n; i++) {
        wetted[i] = 0.0;
        lift[i] = 0.0;
        centre[i] = -level[i];
    }
}

/* and where all of it is in. */
typedef struct {
    _Alignas(64) double volume[FL_FEW];
    double c[3][FL_FEW];
} wholes;

FL_WIDE_VERSIONS static void look_in(const wholes *restrict q, const double *restrict level,
                                     fl_few *restrict a, double weight, double *restrict lift,
                                     double *restrict centre)
{
#pragma omp simd
    for (int32_t i = 0; i < a->lanes; i++) {
        const double ux = a->R[6][i], uy = a->R[7][i], uz = a->R[8][i];
        const double cx = q->c[0][i], cy = q->c[1][i], cz = q->c[2][i];
        const double over_water = ux * cx + uy * cy + uz * cz - level[i], push = weight * q->volume[i];
        const double fx = push * ux, fy = push * uy, fz = push * uz;
        const double tx = cy * fz - cz * fy, ty = cz * fx - cx * fz, tz = cx * fy - cy * fx;
        lift[i] = push;
        centre[i] = over_water;
        a->f[2][i] += push;
        a->t[0][i] += a->R[0][i] * tx + a->R[1][i] * ty + a->R[2][i] * tz;
        a->t[1][i] += a->R[3][i] * tx + a->R[4][i] * ty + a->R[5][i] * tz;
        a->t[2][i] += a->R[6][i] * tx + a->R[7][i] * ty + a->R[8][i] * tz;
    }
}

/* What is kept of them, where it is or in rooms of its own. */
typedef struct {
    double wetted[FL_FEW], lift[FL_FEW], reach[FL_FEW];
} rooms;

static void look_from_far(fl_sea *s, const double *level, fl_few *a, int in, double *wetted, double *lift,
                          double *centre)
{
    if (!in) {
        look_out(level, a->lanes, wetted, lift, centre);
        return;
    }
    wholes q;
    for (int32_t k = 0; k < a->lanes; k++) {
        const fl_hull *h = &s->hull[a->at[k]];
        wetted[k] = h->surface;
        q.volume[k] = h->volume;
        q.c[0][k] = h->centre.x, q.c[1][k] = h->centre.y, q.c[2][k] = h->centre.z;
    }
    look_in(&q, level, a, s->weight, lift, centre);
}

static void flow(fl_sea *s, const fl_few *a, const double *centre)
{
    for (int32_t k = 0; k < a->n && s->flow; k++) s->flow[a->at[k]] = fl_current_at(&s->current, centre[k]);
}

int32_t fl_calm_force(fl_sea *s, const fl_bodies *b, fl_few *a, int32_t left[FL_FEW])
{
    prisms q;
    rooms room;
    _Alignas(64) double centre[FL_FEW]; /* height of the submerged centres over still water [m] */
    double *const wetted = fl_few_room(a, s->wetted, room.wetted);
    double *const lift = fl_few_room(a, s->lift, room.lift);
    const double *const reach = fl_few_see(a, s->reach, room.reach);
    int32_t others = 0, lane = 0;
    double afloat = a->lanes;
    do q.level[lane] = s->level - b->x[a->at[lane]].z;
    while (++lane < a->lanes);
    const int away = fabs(q.level[0]) < reach[0] ? 0 : far(q.level, reach, a->lanes);
    if (away) {
        look_from_far(s, q.level, a, away > 0, wetted, lift, centre);
    } else {
        take(&q, s, a);
        afloat = look(&q, a, s->weight, reach, wetted, lift, centre);
    }
    fl_few_keep(a, s->wetted, wetted), fl_few_keep(a, s->lift, lift);
    flow(s, a, centre);
    for (int32_t k = 0; k < a->n && afloat < a->lanes; k++)
        if (!(q.floats[k] > 0.0)) left[others++] = k;
    return others;
}
