/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "zone/zone_set.h"
#include <string.h>
#include "base/array.h"

/* --- set-up ------------------------------------------------------------------------------------- */

int fl_zone_set_add_material(fl_zone_set *s, const fl_zone_material *m, fl_err *err)
{
    if (fl_grow(&s->material, &s->cap_material, (int64_t)s->materials + 1, sizeof *m, err)) return -1;
    s->material[s->materials++] = *m;
    return 0;
}

int fl_zone_set_add(fl_zone_set *s, const fl_zone_mesh *m, int32_t material, int32_t body, fl_err *err)
{
    int32_t cap_face = s->cap_triangle;
    if ((int64_t)s->zones + m->zones > INT32_MAX / 4)
        return fl_fail(err, FL_INPUT, "there are more than %d zones", INT32_MAX / 4);
    if (fl_grow(&s->block, &s->cap_block, (int64_t)s->blocks + 1, sizeof *s->block, err) ||
        fl_grow(&s->x, &s->cap_node, (int64_t)s->nodes + m->nodes, sizeof *s->x, err) ||
        fl_grow(&s->zone, &s->cap_zone, (int64_t)s->zones + m->zones, sizeof *s->zone, err) ||
        fl_grow(&s->triangle, &s->cap_triangle, (int64_t)s->triangles + m->triangles, sizeof *s->triangle,
                err) ||
        fl_grow(&s->face, &cap_face, (int64_t)s->triangles + m->triangles, sizeof *s->face, err))
        return -1;
    s->block[s->blocks++] = (fl_zone_block){.body = body,
                                            .material = material,
                                            .node = s->nodes,
                                            .node_end = s->nodes + m->nodes,
                                            .zone = s->zones,
                                            .zone_end = s->zones + m->zones,
                                            .triangle = s->triangles,
                                            .triangle_end = s->triangles + m->triangles};
    memcpy(s->x + s->nodes, m->x, (size_t)m->nodes * sizeof *s->x);
    for (int32_t k = 0; k < m->zones; k++)
        for (int e = 0; e < 4; e++) s->zone[s->zones + k][e] = s->nodes + m->zone[k][e];
    for (int32_t k = 0; k < m->triangles; k++) {
        for (int e = 0; e < 3; e++) s->triangle[s->triangles + k][e] = s->nodes + m->triangle[k][e];
        s->face[s->triangles + k] = m->face[k];
    }
    s->nodes += m->nodes, s->zones += m->zones, s->triangles += m->triangles;
    return 0;
}

/* Gradients and volume of a zone. */
static void set_gradients(fl_zone_set *s, int32_t k)
{
    const int32_t *t = s->zone[k];
    const fl_vec3 a = v3_sub(s->x[t[0]], s->x[t[3]]), b = v3_sub(s->x[t[1]], s->x[t[3]]),
                  c = v3_sub(s->x[t[2]], s->x[t[3]]), bc = v3_cross(b, c);
    const double six = v3_dot(a, bc);
    s->gradient[k][0] = v3_scale(1.0 / six, bc);
    s->gradient[k][1] = v3_scale(1.0 / six, v3_cross(c, a));
    s->gradient[k][2] = v3_scale(1.0 / six, v3_cross(a, b));
    s->zone_volume[k] = fabs(six) / 6.0;
}

static fl_vec3 last_gradient(const fl_vec3 g[3]) { return v3_neg(v3_add(v3_add(g[0], g[1]), g[2])); }

/* What a zone gives to K of each of its nodes. */
static double zone_stiffness(const fl_zone_set *s, const fl_zone_material *m, int32_t k)
{
    const fl_vec3 *g = s->gradient[k];
    return (m->lambda + 2.0 * m->mu) * s->zone_volume[k] *
           (v3_norm2(g[0]) + v3_norm2(g[1]) + v3_norm2(g[2]) + v3_norm2(last_gradient(g)));
}

static void add_masses(fl_zone_set *s)
{
    for (int32_t b = 0; b < s->blocks; b++) {
        fl_zone_block *q = &s->block[b];
        const fl_zone_material *m = &s->material[q->material];
        for (int32_t k = q->zone; k < q->zone_end; k++) {
            const double V = s->zone_volume[k], K = zone_stiffness(s, m, k);
            for (int e = 0; e < 4; e++) {
                s->volume[s->zone[k][e]] += 0.25 * V;
                s->m[s->zone[k][e]] += 0.25 * m->density * V;
                s->stiffness[s->zone[k][e]] += K;
            }
            q->mass += m->density * V;
        }
    }
}

/* The corners of each node, ascending. */
static void list_corners(fl_zone_set *s)
{
    for (int32_t k = 0; k < s->zones; k++)
        for (int e = 0; e < 4; e++) s->first[s->zone[k][e] + 1]++;
    for (int32_t n = 0; n < s->nodes; n++) s->first[n + 1] += s->first[n];
    for (int32_t k = 0; k < s->zones; k++)
        for (int e = 0; e < 4; e++) s->corner[s->first[s->zone[k][e]]++] = 4 * k + e;
    for (int32_t n = s->nodes; n > 0; n--) s->first[n] = s->first[n - 1];
    s->first[0] = 0;
}

static int32_t chunks_between(int32_t from, int32_t to)
{
    return (to - from + FL_ZONE_CHUNK - 1) / FL_ZONE_CHUNK;
}

static void append_chunks(fl_zone_chunk *c, int32_t *n, int32_t block, int32_t from, int32_t to)
{
    for (int32_t at = from; at < to; at += FL_ZONE_CHUNK)
        c[(*n)++] = (fl_zone_chunk){block, at, at + FL_ZONE_CHUNK < to ? at + FL_ZONE_CHUNK : to};
}

static int make_chunks(fl_zone_set *s, fl_err *err)
{
    int32_t nodes = 0, zones = 0;
    for (int32_t b = 0; b < s->blocks; b++)
        nodes += chunks_between(s->block[b].node, s->block[b].node_end),
            zones += chunks_between(s->block[b].zone, s->block[b].zone_end);
    s->node_chunk = fl_alloc(nodes, sizeof *s->node_chunk, err);
    s->zone_chunk = fl_alloc(zones, sizeof *s->zone_chunk, err);
    s->sum = fl_alloc(nodes, sizeof *s->sum, err);
    if (!s->node_chunk || !s->zone_chunk || !s->sum) return -1;
    for (int32_t b = 0; b < s->blocks; b++) {
        fl_zone_block *q = &s->block[b];
        q->chunk = s->node_chunks;
        append_chunks(s->node_chunk, &s->node_chunks, b, q->node, q->node_end);
        q->chunk_end = s->node_chunks;
        append_chunks(s->zone_chunk, &s->zone_chunks, b, q->zone, q->zone_end);
    }
    return 0;
}

static int alloc_plastic(fl_zone_set *s, fl_err *err)
{
    int any = 0;
    for (int32_t k = 0; k < s->materials; k++) any |= s->material[k].law != FL_ZONE_ELASTIC;
    if (!any) return 0;
    s->plastic = fl_alloc(s->zones, sizeof *s->plastic, err);
    s->lost = fl_alloc(s->zones, sizeof *s->lost, err);
    s->node_plastic = fl_alloc(s->nodes, sizeof *s->node_plastic, err);
    s->node_lost = fl_alloc(s->nodes, sizeof *s->node_lost, err);
    return s->plastic && s->lost && s->node_plastic && s->node_lost ? 0 : -1;
}

int fl_zone_set_finish(fl_zone_set *s, double share, fl_err *err)
{
    s->share = share, s->inside_out = -1;
    s->v = fl_alloc(s->nodes, sizeof *s->v, err), s->f = fl_alloc(s->nodes, sizeof *s->f, err);
    s->rest = fl_alloc(s->nodes, sizeof *s->rest, err);
    s->m = fl_alloc(s->nodes, sizeof *s->m, err), s->volume = fl_alloc(s->nodes, sizeof *s->volume, err);
    s->stiffness = fl_alloc(s->nodes, sizeof *s->stiffness, err);
    s->fixed = fl_alloc(s->nodes, sizeof *s->fixed, err);
    s->first = fl_alloc((int64_t)s->nodes + 1, sizeof *s->first, err);
    s->corner = fl_alloc(4 * (int64_t)s->zones, sizeof *s->corner, err);
    s->gradient = fl_alloc(s->zones, sizeof *s->gradient, err);
    s->zone_volume = fl_alloc(s->zones, sizeof *s->zone_volume, err);
    s->work = fl_alloc(s->zones, sizeof *s->work, err);
    if (share < 1.0) s->node_stress = fl_alloc(s->nodes, sizeof *s->node_stress, err);
    if (err->code || make_chunks(s, err) || alloc_plastic(s, err)) return -1;
    for (int32_t k = 0; k < s->zones; k++) set_gradients(s, k);
    add_masses(s);
    list_corners(s);
    for (int32_t n = 0; n < s->nodes; n++) s->rest[n] = s->x[n];
    s->inertia = s->m;
    return 0;
}

static int by_size(const void *x, const void *y)
{
    const double a = *(const double *)x, b = *(const double *)y;
    return (a > b) - (a < b);
}

int fl_zone_set_scale_inertia(fl_zone_set *s, fl_err *err)
{
    double *omega2 = fl_alloc(s->nodes, sizeof *omega2, err);
    double *inertia = fl_alloc(s->nodes, sizeof *inertia, err);
    if (!omega2 || !inertia) {
        free(omega2), free(inertia);
        return -1;
    }
    for (int32_t n = 0; n < s->nodes; n++) omega2[n] = s->stiffness[n] / s->m[n];
    qsort(omega2, (size_t)s->nodes, sizeof *omega2, by_size);
    const double median = omega2[s->nodes / 2];
    for (int32_t n = 0; n < s->nodes; n++) inertia[n] = fmax(s->m[n], s->stiffness[n] / median);
    free(omega2);
    s->inertia = inertia;
    return 0;
}

void fl_zone_set_free(fl_zone_set *s)
{
    if (s->inertia != s->m) free(s->inertia);
    free(s->block), free(s->material), free(s->x), free(s->v), free(s->f), free(s->rest), free(s->m);
    free(s->volume), free(s->stiffness), free(s->fixed), free(s->node_stress), free(s->first),
        free(s->corner);
    free(s->zone), free(s->gradient), free(s->zone_volume), free(s->work), free(s->plastic),
        free(s->node_plastic);
    free(s->lost), free(s->node_lost), free(s->triangle), free(s->face), free(s->dashpot),
        free(s->node_chunk);
    free(s->zone_chunk), free(s->sum);
    *s = (fl_zone_set){0};
}

double fl_zone_set_bytes(const fl_zone_set *s)
{
    const size_t yields = s->plastic ? sizeof(fl_sym3) + sizeof(double) : 0,
                 node = 4 * sizeof(fl_vec3) + 3 * sizeof(double) + 1 + sizeof(int64_t) +
                        (s->node_stress ? sizeof(fl_mat3) : 0) + yields,
                 zone = 8 * sizeof(int32_t) + 7 * sizeof(fl_vec3) + sizeof(double) + yields;
    return (double)node * s->nodes + (double)zone * s->zones + 16.0 * s->triangles +
           (double)sizeof(fl_zone_sum) * s->node_chunks;
}

/* --- quiet sides -------------------------------------------------------------------------------- */

static fl_vec3 triangle_area(const fl_zone_set *s, int32_t k)
{
    const int32_t *t = s->triangle[k];
    return v3_scale(0.5, v3_cross(v3_sub(s->x[t[1]], s->x[t[0]]), v3_sub(s->x[t[2]], s->x[t[0]])));
}

static int by_block(const void *x, const void *y)
{
    const fl_zone_dashpot *a = x, *b = y;
    if (a->node != b->node) return (a->node > b->node) - (a->node < b->node); /* nodes follow the blocks */
    for (int k = 0; k < 3; k++) {
        const double p = v3_at(a->normal, k), q = v3_at(b->normal, k);
        if (p != q) return (p > q) - (p < q);
    }
    return 0;
}

/* Dashpots in the order of the blocks, and those of each. */
static void index_dashpots(fl_zone_set *s)
{
    int32_t d = 0;
    if (s->dashpots) qsort(s->dashpot, (size_t)s->dashpots, sizeof *s->dashpot, by_block);
    for (int32_t b = 0; b < s->blocks; b++) {
        s->block[b].dashpot = d;
        while (d < s->dashpots && s->dashpot[d].block == b) d++;
        s->block[b].dashpot_end = d;
    }
}

int fl_zone_set_add_quiet(fl_zone_set *s, const uint8_t *is_quiet, fl_vec3 n, fl_err *err)
{
    double *area = fl_alloc(s->nodes, sizeof *area, err);
    int32_t more = 0, cap = s->dashpots;
    if (!area) return -1;
    for (int32_t k = 0; k < s->triangles; k++)
        for (int e = 0; e < 3 && is_quiet[k]; e++)
            area[s->triangle[k][e]] += v3_norm(triangle_area(s, k)) / 3.0;
    for (int32_t k = 0; k < s->nodes; k++) more += area[k] > 0.0;
    if (fl_grow(&s->dashpot, &cap, (int64_t)s->dashpots + more, sizeof *s->dashpot, err)) {
        free(area);
        return -1;
    }
    for (int32_t b = 0; b < s->blocks; b++)
        for (int32_t k = s->block[b].node; k < s->block[b].node_end; k++)
            if (area[k] > 0.0) s->dashpot[s->dashpots++] = (fl_zone_dashpot){k, b, n, area[k]};
    index_dashpots(s);
    free(area);
    return 0;
}

fl_vec3 fl_zone_dashpot_force(const fl_zone_set *s, int32_t d, fl_vec3 in, fl_vec3 *own)
{
    const fl_zone_dashpot *q = &s->dashpot[d];
    const fl_zone_material *m = &s->material[s->block[q->block].material];
    const double zp = sqrt(m->density * (m->lambda + 2.0 * m->mu)), zs = sqrt(m->density * m->mu),
                 vn = v3_dot(q->normal, s->v[q->node]);
    *own = v3_scale(-q->area, v3_madd(v3_scale(zs, s->v[q->node]), (zp - zs) * vn, q->normal));
    return v3_madd(*own, 2.0 * q->area, in);
}

/* --- passes ------------------------------------------------------------------------------------- */

static fl_mat3 gradient_of(const fl_vec3 c[3])
{
    return (fl_mat3){{{c[0].x, c[1].x, c[2].x}, {c[0].y, c[1].y, c[2].y}, {c[0].z, c[1].z, c[2].z}}};
}

/* Columns of F of a zone. */
static void deform_zone(const fl_zone_set *s, int32_t k, fl_vec3 F[3])
{
    const int32_t *t = s->zone[k];
    const fl_vec3 *g = s->gradient[k], o = s->x[t[3]], a = v3_sub(s->x[t[0]], o), b = v3_sub(s->x[t[1]], o),
                  c = v3_sub(s->x[t[2]], o);
    F[0] = v3_madd(v3_madd(v3_scale(g[0].x, a), g[1].x, b), g[2].x, c);
    F[1] = v3_madd(v3_madd(v3_scale(g[0].y, a), g[1].y, b), g[2].y, c);
    F[2] = v3_madd(v3_madd(v3_scale(g[0].z, a), g[1].z, b), g[2].z, c);
}

/* Mean F of the zones around a node. */
static fl_mat3 average_at(const fl_zone_set *s, int32_t n)
{
    fl_vec3 F[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    const double part = 0.25 / s->volume[n];
    for (int64_t c = s->first[n]; c < s->first[n + 1]; c++) {
        const int32_t k = s->corner[c] >> 2;
        const double w = part * s->zone_volume[k];
        for (int e = 0; e < 3; e++) F[e] = v3_madd(F[e], w, s->work[k][e]);
    }
    return gradient_of(F);
}

/* Any of the zones that are will do for a message. */
static void note_inside_out(fl_zone_set *s, int32_t zone)
{
#pragma omp critical(fl_zone_inside_out)
    s->inside_out = zone;
}

/* P = R s at F. */
static int stress_at(const fl_zone_material *m, const fl_mat3 *F, fl_sym3 *plastic, double *lost, fl_mat3 *P)
{
    fl_mat3 R;
    if (!fl_zone_rotation(F, &R)) {
        *P = (fl_mat3){0};
        return 0;
    }
    const fl_sym3 t = fl_zone_stress(m, fl_zone_strain(F, &R), plastic, lost);
    for (int i = 0; i < 3; i++) {
        const double *r = R.m[i];
        P->m[i][0] = r[0] * t.xx + r[1] * t.xy + r[2] * t.xz;
        P->m[i][1] = r[0] * t.xy + r[1] * t.yy + r[2] * t.yz;
        P->m[i][2] = r[0] * t.xz + r[1] * t.yz + r[2] * t.zz;
    }
    return 1;
}

void fl_zone_deform(fl_zone_set *s, int32_t from, int32_t to)
{
    for (int32_t c = from; c < to; c++)
        for (int32_t k = s->zone_chunk[c].from; k < s->zone_chunk[c].to; k++) deform_zone(s, k, s->work[k]);
}

void fl_zone_average(fl_zone_set *s, int32_t from, int32_t to)
{
    if (!s->node_stress) return;
    for (int32_t c = from; c < to; c++) {
        const fl_zone_chunk q = s->node_chunk[c];
        const fl_zone_material *m = &s->material[s->block[q.block].material];
        const int yields = m->law != FL_ZONE_ELASTIC;
        for (int32_t n = q.from; n < q.to; n++) {
            const fl_mat3 F = average_at(s, n);
            if (!stress_at(m, &F, yields ? &s->node_plastic[n] : NULL, yields ? &s->node_lost[n] : NULL,
                           &s->node_stress[n]))
                note_inside_out(s, s->corner[s->first[n]] >> 2);
        }
    }
}

/* k P(F_e) + (1 - k)/4 sum P(F_n) */
static fl_mat3 blended_stress(const fl_zone_set *s, int32_t k, const fl_mat3 *own)
{
    fl_mat3 P;
    const int32_t *t = s->zone[k];
    const double w = 0.25 * (1.0 - s->share);
    const fl_mat3 *a = &s->node_stress[t[0]], *b = &s->node_stress[t[1]], *c = &s->node_stress[t[2]],
                  *d = &s->node_stress[t[3]];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            P.m[i][j] = s->share * own->m[i][j] + w * ((a->m[i][j] + b->m[i][j]) + (c->m[i][j] + d->m[i][j]));
    return P;
}

void fl_zone_corner_forces(fl_zone_set *s, int32_t from, int32_t to)
{
    for (int32_t c = from; c < to; c++) {
        const fl_zone_chunk q = s->zone_chunk[c];
        const fl_zone_material *m = &s->material[s->block[q.block].material];
        const int yields = m->law != FL_ZONE_ELASTIC;
        for (int32_t k = q.from; k < q.to; k++) {
            fl_mat3 P = {0};
            const fl_mat3 F = gradient_of(s->work[k]);
            const fl_vec3 *g = s->gradient[k];
            if (s->share > 0.0 &&
                !stress_at(m, &F, yields ? &s->plastic[k] : NULL, yields ? &s->lost[k] : NULL, &P))
                note_inside_out(s, k);
            if (s->node_stress) P = blended_stress(s, k, &P);
            fl_vec3 last = v3(0, 0, 0);
            for (int e = 0; e < 3; e++) {
                s->work[k][e] = v3_scale(-s->zone_volume[k], m3_mul(P, g[e]));
                last = v3_sub(last, s->work[k][e]);
            }
            s->work[k][3] = last;
        }
    }
}

/* --- results ------------------------------------------------------------------------------------ */

double fl_zone_omega2(const fl_zone_set *s, int32_t *node)
{
    double most = 0.0;
    *node = -1;
    for (int32_t n = 0; n < s->nodes; n++)
        if (s->fixed[n] != (FL_DOF_X | FL_DOF_Y | FL_DOF_Z) && s->stiffness[n] > most * s->inertia[n])
            most = s->stiffness[n] / s->inertia[n], *node = n;
    return most;
}

/* Mean F around a node, from the places alone. */
static fl_mat3 average_now(const fl_zone_set *s, int32_t n)
{
    fl_vec3 F[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, G[3];
    for (int64_t c = s->first[n]; c < s->first[n + 1]; c++) {
        const int32_t k = s->corner[c] >> 2;
        deform_zone(s, k, G);
        for (int e = 0; e < 3; e++) F[e] = v3_madd(F[e], 0.25 * s->zone_volume[k] / s->volume[n], G[e]);
    }
    return gradient_of(F);
}

/* R s R^T at F; the plastic strain stays. */
static fl_sym3 cauchy_at(const fl_zone_material *m, const fl_mat3 *F, const fl_sym3 *plastic)
{
    fl_mat3 R;
    if (!fl_zone_rotation(F, &R)) return (fl_sym3){0};
    fl_sym3 e = fl_zone_strain(F, &R);
    if (plastic) e = s3_add(e, s3_times(-1.0, *plastic));
    return s3_rotated(fl_zone_stress(m, e, NULL, NULL), m3_col(R, 0), m3_col(R, 1), m3_col(R, 2));
}

static int32_t block_of_zone(const fl_zone_set *s, int32_t zone)
{
    int32_t lo = 0, hi = s->blocks - 1;
    while (lo < hi) {
        const int32_t mid = (lo + hi + 1) / 2;
        if (s->block[mid].zone <= zone) lo = mid;
        else hi = mid - 1;
    }
    return lo;
}

fl_sym3 fl_zone_cauchy(const fl_zone_set *s, int32_t zone)
{
    const fl_zone_material *m = &s->material[s->block[block_of_zone(s, zone)].material];
    const int yields = m->law != FL_ZONE_ELASTIC;
    fl_vec3 c[3];
    deform_zone(s, zone, c);
    const fl_mat3 F = gradient_of(c);
    fl_sym3 sum = s3_times(s->share, cauchy_at(m, &F, yields ? &s->plastic[zone] : NULL));
    for (int e = 0; e < 4 && s->node_stress; e++) {
        const int32_t n = s->zone[zone][e];
        const fl_mat3 G = average_now(s, n);
        sum = s3_add(
            sum, s3_times(0.25 * (1.0 - s->share), cauchy_at(m, &G, yields ? &s->node_plastic[n] : NULL)));
    }
    return sum;
}

double fl_zone_own_stiffness(const fl_zone_set *s, int32_t node)
{
    double sum = 0.0;
    for (int64_t c = s->first[node]; c < s->first[node + 1]; c++) {
        const int32_t k = s->corner[c] >> 2;
        sum += zone_stiffness(s, &s->material[s->block[block_of_zone(s, k)].material], k);
    }
    return sum;
}

double fl_zone_lost(const fl_zone_set *s, int32_t zone)
{
    double sum = 0.0;
    if (!s->plastic) return 0.0;
    for (int e = 0; e < 4 && s->node_stress; e++)
        sum += 0.25 * (1.0 - s->share) * s->node_lost[s->zone[zone][e]];
    return sum + s->share * s->lost[zone];
}

static double energy_at(const fl_zone_material *m, const fl_mat3 *F, const fl_sym3 *plastic)
{
    fl_mat3 R;
    return fl_zone_rotation(F, &R) ? fl_zone_energy(m, fl_zone_strain(F, &R), plastic) : 0.0;
}

fl_zone_energies fl_zone_set_energies(const fl_zone_set *s)
{
    fl_zone_energies out = {0};
    for (int32_t b = 0; b < s->blocks; b++) {
        const fl_zone_block *q = &s->block[b];
        const fl_zone_material *m = &s->material[q->material];
        const int yields = m->law != FL_ZONE_ELASTIC;
        if (q->absent) continue;
        for (int32_t k = q->zone; k < q->zone_end; k++) {
            fl_vec3 c[3];
            deform_zone(s, k, c);
            const fl_mat3 F = gradient_of(c);
            const double V = s->share * s->zone_volume[k];
            out.stored += V * energy_at(m, &F, yields ? &s->plastic[k] : NULL);
            if (yields) out.plastic += V * s->lost[k];
        }
        for (int32_t n = q->node; n < q->node_end; n++) {
            out.kinetic += 0.5 * s->inertia[n] * v3_norm2(s->v[n]);
            if (!s->node_stress) continue;
            const fl_mat3 F = average_now(s, n);
            const double V = (1.0 - s->share) * s->volume[n];
            out.stored += V * energy_at(m, &F, yields ? &s->node_plastic[n] : NULL);
            if (yields) out.plastic += V * s->node_lost[n];
        }
    }
    return out;
}

/* --- pose --------------------------------------------------------------------------------------- */

void fl_zone_chunk_sums(fl_zone_set *s, const fl_bodies *b, int32_t chunk)
{
    const fl_zone_chunk q = s->node_chunk[chunk];
    const fl_vec3 o = b->x[s->block[q.block].body];
    fl_zone_sum *r = &s->sum[chunk];
    r->momentum = r->moment = r->first = v3(0, 0, 0);
    r->shape = (fl_mat3){0};
    for (int32_t n = q.from; n < q.to; n++) {
        const fl_vec3 d = v3_sub(s->x[n], o), X = s->rest[n];
        const double m = s->m[n];
        r->momentum = v3_madd(r->momentum, m, s->v[n]);
        r->moment = v3_madd(r->moment, m, v3_cross(d, s->v[n]));
        r->first = v3_madd(r->first, m, d);
        const double e[3] = {m * d.x, m * d.y, m * d.z};
        for (int i = 0; i < 3; i++)
            r->shape.m[i][0] += e[i] * X.x, r->shape.m[i][1] += e[i] * X.y, r->shape.m[i][2] += e[i] * X.z;
    }
}

void fl_zone_set_pose(const fl_zone_set *s, int32_t k, fl_bodies *b)
{
    const fl_zone_block *q = &s->block[k];
    fl_vec3 p = v3(0, 0, 0), l = p, first = p;
    fl_mat3 A = {0}, R;
    for (int32_t c = q->chunk; c < q->chunk_end; c++) {
        const fl_zone_sum *r = &s->sum[c];
        p = v3_add(p, r->momentum), l = v3_add(l, r->moment), first = v3_add(first, r->first);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) A.m[i][j] += r->shape.m[i][j];
    }
    double size = 0.0; /* the axes of the body may be any */
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) size += fabs(A.m[i][j]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) A.m[i][j] /= size;
    const fl_vec3 off = v3_scale(1.0 / q->mass, first);
    b->x[q->body] = v3_add(b->x[q->body], off);
    b->v[q->body] = v3_scale(1.0 / q->mass, p);
    b->L[q->body] = v3_sub(l, v3_cross(off, p));
    if (fl_zone_rotation(&A, &R)) b->q[q->body] = q_of_matrix(R);
    fl_body_update_spin(b, q->body);
}
