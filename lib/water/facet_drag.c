/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "water/facet_drag.h"

int32_t fl_skin_most(const fl_hull *h)
{
    const fl_poly *p = h->p;
    return p->nf ? 3 * (p->first[p->nf] + 2 * p->nf) : 0;
}

/* The corners of what is left of a face, one after another: the sum of its parts, or its pieces. */
typedef struct {
    fl_vec3 n, hub, last, head; /* head: the first corner */
    int corners;
    double area;    /* of the fan about hub      */
    fl_vec3 moment; /* int (x - hub) dA          */
    fl_skin_piece *out;
    int32_t pieces, spoke, first; /* the pieces towards the last corner and the first, -1: none yet */
} outline;

/* Add to the piece *at half way to x from the hub, a new one where that is -1. */
static void spoke(outline *o, int32_t *at, fl_vec3 x, double area)
{
    if (*at < 0) {
        *at = o->pieces++;
        o->out[*at] = (fl_skin_piece){.n = o->n, .r = v3_madd(o->hub, 0.5, x)};
    }
    o->out[*at].area += area;
}

static void side(outline *o, fl_vec3 a, fl_vec3 b, int closing)
{
    const fl_vec3 x = v3_sub(a, o->hub), y = v3_sub(b, o->hub);
    const double area = 0.5 * v3_dot(o->n, v3_cross(x, y));
    o->area += area;
    o->moment = v3_madd(o->moment, area / 3.0, v3_add(x, y));
    if (!o->out) return;
    if (!(area > 0.0)) {
        o->spoke = -1;
        if (o->first == -1) o->first = -2; /* then the last triangle has no neighbour there */
        return;
    }
    /* a third each to the middles of the two spokes, which neighbours share, and to that of the rim */
    spoke(o, &o->spoke, x, area / 3.0);
    if (o->first == -1) o->first = o->spoke;
    int32_t next = closing && o->first >= 0 ? o->first : -1;
    spoke(o, &next, y, area / 3.0);
    o->spoke = next;
    next = -1;
    spoke(o, &next, v3_add(x, y), area / 3.0);
}

static void corner(outline *o, fl_vec3 x)
{
    if (o->corners++) side(o, o->last, x, 0);
    else o->head = x;
    o->last = x;
}

/* Round face f; sign +1 keeps what is below the plane, -1 what is above it. */
static void walk(const fl_poly *p, int32_t f, fl_vec3 up, double level, double sign, outline *o)
{
    const int32_t *at = p->loop + p->first[f], m = p->first[f + 1] - p->first[f];
    fl_vec3 from = p->v[at[m - 1]];
    double s0 = sign * (v3_dot(up, from) - level);
    for (int32_t k = 0; k < m; k++) {
        const fl_vec3 to = p->v[at[k]];
        const double s1 = sign * (v3_dot(up, to) - level);
        if ((s0 <= 0.0) != (s1 <= 0.0)) corner(o, v3_lerp(from, to, s0 / (s0 - s1)));
        if (s1 <= 0.0) corner(o, to);
        from = to;
        s0 = s1;
    }
    if (o->corners > 2) side(o, o->last, o->head, 1);
}

int32_t fl_skin_pieces(const fl_hull *h, fl_vec3 up, double level, int dry, fl_skin_piece *out)
{
    const fl_poly *p = h->p;
    const double sign = dry ? -1.0 : 1.0;
    int32_t pieces = 0;
    for (int32_t f = 0; f < p->nf; f++) {
        outline whole = {.n = p->n[f], .hub = h->middle[f]};
        walk(p, f, up, level, sign, &whole);
        if (whole.corners < 3 || !(whole.area > 0.0)) continue;
        outline fan = {.n = p->n[f],
                       .hub = v3_madd(whole.hub, 1.0 / whole.area, whole.moment),
                       .out = out + pieces,
                       .spoke = -1,
                       .first = -1};
        walk(p, f, up, level, sign, &fan);
        pieces += fan.pieces;
    }
    return pieces;
}

/* Solve the symmetric system a x = y of six, lower half of a given (Cholesky).  a is 1 and something that is
 * never negative, so no pivot is below 1, but for rounding where that something is 1e16 times larger. */
static void solve6(double a[6][6], double *x)
{
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < i; j++) {
            double s = a[i][j];
            for (int l = 0; l < j; l++) s -= a[i][l] * a[j][l];
            a[i][j] = s / a[j][j];
        }
        double s = a[i][i];
        for (int l = 0; l < i; l++) s -= a[i][l] * a[i][l];
        a[i][i] = sqrt(fmax(s, 1.0));
    }
    for (int i = 0; i < 6; i++) {
        for (int l = 0; l < i; l++) x[i] -= a[i][l] * x[l];
        x[i] /= a[i][i];
    }
    for (int i = 5; i >= 0; i--) {
        for (int l = i + 1; l < 6; l++) x[i] -= a[l][i] * x[l];
        x[i] /= a[i][i];
    }
}

/* Each speed over the root of its mass: then the matrix is 1 + what drag adds, and the root in solve6() is of
 * numbers of at least 1, whatever the units and however strong the drag. */
void fl_facet_drag(int32_t n, const fl_skin_piece *piece, double skin, double form, fl_vec3 mass,
                   fl_vec3 inertia, double h, fl_vec3 *v, fl_vec3 *w)
{
    const double M[6] = {mass.x, mass.y, mass.z, inertia.x, inertia.y, inertia.z};
    double a[6][6] = {{0}}, x[6], root[6];
    fl_vec3 push = {0}, turn = {0};
    for (int32_t k = 0; k < n; k++) {
        const fl_vec3 r = piece[k].r, m = piece[k].n, U = piece[k].flow;
        const fl_vec3 u = v3_sub(v3_add(*v, v3_cross(*w, r)), U);
        const double un = v3_dot(u, m), ut = v3_norm(v3_madd(u, -un, m));
        const double s = h * skin * piece[k].area * ut, b = h * form * piece[k].area * fmax(un, 0.0) - s;
        const fl_vec3 q = v3_cross(r, m), d = v3_add(v3_scale(s, U), v3_scale(b * v3_dot(m, U), m));
        const double g[6] = {m.x, m.y, m.z, q.x, q.y, q.z};
        const double rr = v3_norm2(r), e[3] = {r.x, r.y, r.z};
        push = v3_add(push, d);
        turn = v3_add(turn, v3_cross(r, d));
        for (int i = 0; i < 6; i++)
            for (int j = 0; j <= i; j++) a[i][j] += b * g[i] * g[j];
        for (int i = 0; i < 3; i++) {
            a[i][i] += s;
            for (int j = 0; j <= i; j++) a[3 + i][3 + j] -= s * e[i] * e[j];
            a[3 + i][3 + i] += s * rr;
        }
        /* (e_i x r).e_j */
        a[3][1] += -s * r.z, a[3][2] += s * r.y;
        a[4][0] += s * r.z, a[4][2] += -s * r.x;
        a[5][0] += -s * r.y, a[5][1] += s * r.x;
    }
    const double y[6] = {v->x, v->y, v->z, w->x, w->y, w->z},
                 p[6] = {push.x, push.y, push.z, turn.x, turn.y, turn.z};
    for (int i = 0; i < 6; i++) {
        root[i] = sqrt(M[i]);
        x[i] = (M[i] * y[i] + p[i]) / root[i];
        for (int j = 0; j <= i; j++) a[i][j] /= root[i] * root[j];
        a[i][i] += 1.0;
    }
    solve6(a, x);
    *v = v3(x[0] / root[0], x[1] / root[1], x[2] / root[2]);
    *w = v3(x[3] / root[3], x[4] / root[4], x[5] / root[5]);
}
