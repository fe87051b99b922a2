/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pieces that touch are one surface: its volume, its contacts, and the loads of its parts. */
#include "support/near.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "base/pi.h"
#include "base/rng.h"
#include "contact/pair_force.h"
#include "contact/pair_store.h"
#include "contact/panel_load.h"
#include "narrow/closest_point.h"
#include "structure/mesh_contact.h"
#include "structure/region.h"
#include "support/small_world.h"

static const fl_vec3 ZERO = {0, 0, 0};

static fl_part *new_part(fl_surface *s)
{
    fl_err err = {0};
    const int32_t k = fl_surface_add(s, "part", 4, &err);
    assert_true(k >= 0);
    return &s->part[k];
}

/* Appends a quadrilateral to a part, with vertices of its own unless they are there. */
static void add_quad(fl_part *p, const fl_vec3 *at)
{
    fl_err err = {0};
    int32_t v[4];
    for (int k = 0; k < 4; k++) {
        for (v[k] = 0; v[k] < p->nv && v3_norm(v3_sub(p->v[v[k]], at[k])) > 0.0; v[k]++) {}
        if (v[k] == p->nv) assert_int_equal(fl_surface_vertex(p, at[k], &err), 0);
    }
    assert_int_equal(fl_surface_triangle(p, v[0], v[1], v[2], &err), 0);
    assert_int_equal(fl_surface_triangle(p, v[0], v[2], v[3], &err), 0);
}

/* A quadrilateral; the first part takes it if `one`, else a new part. */
static void lab_quad(lab *l, int one, fl_vec3 a, fl_vec3 b, fl_vec3 c, fl_vec3 d)
{
    fl_part *p = one && l->surface.n ? &l->surface.part[0] : new_part(&l->surface);
    add_quad(p, (fl_vec3[4]){a, b, c, d});
}

static fl_structure build_joined(const fl_surface *s, const int32_t *mover)
{
    fl_structure st = {0};
    fl_err err = {0};
    if (fl_structure_build(&st, s, &err) || fl_regions_join(&st, s, mover, ZERO, &err))
        fail_msg("%s", err.text);
    assert_int_equal(st.unjoined, 0);
    return st;
}

/* Volume that the faces of a piece enclose. */
static double volume_of(const fl_piece *p)
{
    double six = 0.0;
    for (int32_t f = 0; f < p->core.nf; f++) {
        const int32_t *loop = p->core.loop + p->core.first[f], n = p->core.first[f + 1] - p->core.first[f];
        for (int32_t k = 2; k < n; k++)
            six += v3_dot(p->core.v[loop[0]], v3_cross(p->core.v[loop[k - 1]], p->core.v[loop[k]]));
    }
    return six / 6.0;
}

static double whole_volume(const fl_structure *s)
{
    double sum = 0.0;
    for (int32_t k = 0; k < s->n; k++) sum += volume_of(&s->piece[k]);
    return sum;
}

/* --- the union ---------------------------------------------------------------------------------- */

/* A whole number from 0 to n - 1. */
static int below(fl_rng *r, int n) { return (int)(fl_rng_unit(r) * n); }

enum { CELLS = 6 };

/* Boxes on a grid share faces, edges and corners in all ways. */
static void boxes_on_a_grid_have_the_volume_of_their_cells(void **state)
{
    (void)state;
    const long cases = test_times(60);
    for (long c = 0; c < cases; c++) {
        fl_rng r = fl_rng_of(test_seed(), c, 77);
        uint8_t full[CELLS][CELLS][CELLS] = {{{0}}};
        double expected = 0.0;
        lab l;
        lab_start(&l);
        const int boxes = 2 + below(&r, 4);
        for (int b = 0; b < boxes; b++) {
            int lo[3], hi[3];
            for (int k = 0; k < 3; k++) {
                lo[k] = below(&r, CELLS - 1);
                hi[k] = lo[k] + 1 + below(&r, 3);
                if (hi[k] > CELLS) hi[k] = CELLS;
            }
            for (int x = lo[0]; x < hi[0]; x++)
                for (int y = lo[1]; y < hi[1]; y++)
                    for (int z = lo[2]; z < hi[2]; z++) expected += !full[x][y][z], full[x][y][z] = 1;
            lab_wall(&l, v3(lo[0], lo[1], lo[2]), v3(hi[0], hi[1], hi[2]), 1);
        }
        fl_structure st = build_joined(&l.surface, NULL);
        assert_near_of(whole_volume(&st), expected, 1e-9, expected);
        /* inside and outside: centres of the cells */
        for (int x = -1; x <= CELLS; x++)
            for (int y = -1; y <= CELLS; y++)
                for (int z = -1; z <= CELLS; z++) {
                    const fl_vec3 at = v3(x + 0.5, y + 0.5, z + 0.5);
                    const int is =
                        x >= 0 && y >= 0 && z >= 0 && x < CELLS && y < CELLS && z < CELLS && full[x][y][z];
                    int found = 0;
                    for (int32_t k = 0; k < st.n; k++) {
                        const fl_piece *p = &st.piece[k];
                        const fl_vec3 in = v3_sub(at, p->x);
                        found |= p->kind == FL_PIECE_MESH ? fl_mesh_contact_contains(p, in)
                                                          : fl_closest_on_poly(&p->core, in).d < 0.0;
                    }
                    if (found != is) fail_msg("case %ld: cell %d %d %d", c, x, y, z);
                }
        fl_structure_free(&st);
        lab_free(&l);
    }
}

/* True if x lies in a turned box of half sides h, or a cone. */
typedef struct {
    fl_vec3 x, h;
    fl_quat q;
    double r0, r1, length;
} body;

static int is_in(const body *b, fl_vec3 x)
{
    const fl_vec3 at = q_rotate(q_conj(b->q), v3_sub(x, b->x));
    if (b->length > 0.0) return fl_closest_on_cone(b->r0, b->r1, b->length, at).d < 0.0;
    return fabs(at.x) < b->h.x && fabs(at.y) < b->h.y && fabs(at.z) < b->h.z;
}

static void add_body(lab *l, const body *b)
{
    if (b->length > 0.0) {
        lab_cone(l, (fl_cone){b->x, v3_add(b->x, q_rotate(b->q, v3(0, 0, b->length))), b->r0, b->r1});
        return;
    }
    lab_wall(l, v3_neg(b->h), b->h, 1);
    fl_part *p = &l->surface.part[l->surface.n - 1];
    for (int32_t v = 0; v < p->nv; v++) p->v[v] = v3_add(b->x, q_rotate(b->q, p->v[v]));
}

static void bodies_at_any_angle_have_the_volume_of_their_union(void **state)
{
    (void)state;
    const long cases = test_times(12);
    for (long c = 0; c < cases; c++) {
        enum { POINTS = 40000 };
        fl_rng r = fl_rng_of(test_seed(), c, 78);
        body b[4];
        int inside = 0;
        lab l;
        lab_start(&l);
        const int bodies = 2 + below(&r, 3);
        for (int k = 0; k < bodies; k++) {
            b[k] =
                (body){.x = v3(fl_rng_in(&r, -0.7, 0.7), fl_rng_in(&r, -0.7, 0.7), fl_rng_in(&r, -0.7, 0.7)),
                       .h = v3(fl_rng_in(&r, 0.2, 1), fl_rng_in(&r, 0.2, 1), fl_rng_in(&r, 0.2, 1))};
            b[k].q = q_of_vector(v3(fl_rng_in(&r, -2, 2), fl_rng_in(&r, -2, 2), fl_rng_in(&r, -2, 2)));
            if (below(&r, 2))
                b[k].length = fl_rng_in(&r, 0.5, 2), b[k].r0 = fl_rng_in(&r, 0.1, 0.6),
                b[k].r1 = fl_rng_in(&r, 0.1, 0.6);
            add_body(&l, &b[k]);
        }
        for (int k = 0; k < POINTS; k++) {
            const fl_vec3 x = v3(fl_rng_in(&r, -3, 3), fl_rng_in(&r, -3, 3), fl_rng_in(&r, -3, 3));
            int in = 0;
            for (int j = 0; j < bodies; j++) in |= is_in(&b[j], x);
            inside += in;
        }
        fl_structure st = build_joined(&l.surface, NULL);
        const double share = (double)inside / POINTS,
                     sigma = sqrt(share * (1.0 - share) / POINTS) + 1.0 / POINTS;
        if (!(fabs(whole_volume(&st) / 216.0 - share) <= 5.0 * sigma))
            fail_msg("case %ld: volume %g, %g +- %g expected", c, whole_volume(&st), 216.0 * share,
                     216.0 * sigma);
        fl_structure_free(&st);
        lab_free(&l);
    }
}

/* --- contacts ----------------------------------------------------------------------------------- */

/* A floe of 1 m at random poses near the origin loads `one` and `parts` alike, within tol of the largest
 * force. */
static void loads_alike(lab *one, lab *parts, fl_vec3 middle, double spread, double tol)
{
    const long cases = test_times(400);
    double largest = 0.0, off = 0.0;
    int touching = 0;
    for (long c = 0; c < cases; c++) {
        fl_rng r = fl_rng_of(test_seed(), c, 79);
        const fl_vec3 x =
            v3(fl_rng_in(&r, -spread, spread), fl_rng_in(&r, -spread, spread), fl_rng_in(&r, 0, 0.12));
        const fl_quat q =
            q_of_vector(v3(fl_rng_in(&r, -0.1, 0.1), fl_rng_in(&r, -0.1, 0.1), fl_rng_in(&r, -3, 3)));
        lab *const both[2] = {one, parts};
        fl_pair p[2];
        for (int k = 0; k < 2; k++) {
            lab_pose(&both[k]->w, 0, v3_add(middle, x), q);
            p[k] = lab_evaluate_pair(&both[k]->w, 0, 1);
        }
        assert_int_equal(p[0].touching, p[1].touching);
        if (!p[0].touching || p[0].overlap > 0.0499 || p[1].overlap > 0.0499) continue; /* not the cores */
        touching++;
        largest = fmax(largest, v3_norm(p[0].force));
        off = fmax(off, v3_norm(v3_sub(p[0].force, p[1].force)));
        off = fmax(off, v3_norm(v3_sub(p[0].torque_i, p[1].torque_i)));
    }
    assert_true(touching > cases / 20);
    assert_near_of(off, 0.0, tol, largest);
}

static void start(lab *l)
{
    lab_start(l);
    lab_box(l, v3(50, 0, 0), v3(0.5, 0.5, 0.5), 0.05, q_one(), ZERO, ZERO);
}

static void a_seam_of_flat_walls_leaves_no_trace(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        lab l[2];
        for (int k = 0; k < 2; k++) {
            start(&l[k]);
            const double low = kind == 0 ? 0.0 : kind == 1 ? -0.5 : 0.5; /* flat; a ridge; a valley */
            lab_quad(&l[k], k == 0, v3(-2, -2, low), v3(0, -2, 0), v3(0, 2, 0), v3(-2, 2, low));
            lab_quad(&l[k], k == 0, v3(0, -2, 0), v3(2, -2, low), v3(2, 2, low), v3(0, 2, 0));
            lab_make(&l[k], 1e-9);
            assert_int_equal(l[k].w.pieces, 1);
        }
        assert_true(l[1].w.structure.piece[0].several_parts);
        loads_alike(&l[0], &l[1], v3(0, 0, kind == 2 ? 0.52 : 0.45), 0.4, 1e-12);
        lab_free(&l[0]), lab_free(&l[1]);
    }
}

/* Corners of one wall on the side of the other; walls that overlap; a box in two. */
static void however_they_meet(void **state)
{
    (void)state;
    for (int kind = 0; kind < 4; kind++) {
        lab l[2];
        for (int k = 0; k < 2; k++) {
            start(&l[k]);
            if (k == 0) lab_wall(&l[k], v3(-2, -2, -1), v3(2, 2, 0), 1);
            else if (kind == 0)
                lab_wall(&l[k], v3(-2, -2, -1), v3(0, 2, 0), 1),
                    lab_wall(&l[k], v3(0, -2, -1), v3(2, 2, 0), 1);
            else if (kind == 1)
                lab_wall(&l[k], v3(-2, -2, -1), v3(0.3, 2, 0), 1),
                    lab_wall(&l[k], v3(-0.2, -2, -1), v3(2, 2, 0), 3);
            else {
                lab_wall(&l[k], v3(-2, -2, -1), v3(0, 2, 0), 1);
                lab_wall(&l[k], v3(0, -2, -1), v3(2, 0.1, kind == 2 ? 0 : -1e-9), 1);
                lab_wall(&l[k], v3(0, 0.1, -1), v3(2, 2, 0), 1);
            }
            lab_make(&l[k], 1e-9);
            assert_int_equal(l[k].w.pieces, 1);
        }
        loads_alike(&l[0], &l[1], v3(0, 0, 0.45), 0.4, kind == 3 ? 1e-6 : 1e-12);
        lab_free(&l[0]), lab_free(&l[1]);
    }
}

/* A leg in two parts is one cylinder, exactly. */
static void cones_that_continue_are_one(void **state)
{
    (void)state;
    for (int turned = 0; turned < 2; turned++) {
        lab l[2];
        for (int k = 0; k < 2; k++) {
            start(&l[k]);
            const fl_vec3 a = v3(0, -5, -2), b = v3(0, 0, -2), c = v3(0, 4, -2);
            if (k == 0) lab_cone(&l[k], (fl_cone){a, c, 2.0, 2.0});
            else
                lab_cone(&l[k], (fl_cone){a, b, 2, 2}),
                    lab_cone(&l[k], turned ? (fl_cone){c, b, 2, 2} : (fl_cone){b, c, 2, 2});
            lab_make(&l[k], 1e-9);
            assert_int_equal(l[k].w.pieces, 1);
            assert_int_equal(l[k].w.structure.piece[0].kind, FL_PIECE_CONE);
        }
        loads_alike(&l[0], &l[1], v3(0, 0, 0.42), 0.4, 1e-12);
        lab_free(&l[0]), lab_free(&l[1]);
    }
}

/* The force is that of one wall with the same overlap, not of two: a floe flat on a plate across the end of a
 * cylinder, on a plate that stands in a wall, over a joint. */
static void make_joint(lab *l, int kind)
{
    start(l);
    if (kind == 0) { /* a deck on a leg */
        lab_cone(l, (fl_cone){v3(0, 0, -5), v3(0, 0, 0), 1, 1});
        lab_quad(l, 0, v3(-3, -3, 0), v3(3, -3, 0), v3(3, 3, 0), v3(-3, 3, 0));
    } else if (kind == 1) { /* a plate with a stiffener below it */
        lab_quad(l, 0, v3(-3, -3, 0), v3(3, -3, 0), v3(3, 3, 0), v3(-3, 3, 0));
        lab_quad(l, 0, v3(0.1, -3, -2), v3(0.1, 3, -2), v3(0.1, 3, 0), v3(0.1, -3, 0));
    } else if (kind == 2) { /* the same on a wall, the stiffener going through */
        lab_quad(l, 0, v3(-3, -3, 0), v3(3, -3, 0), v3(3, 3, 0), v3(-3, 3, 0));
        lab_wall(l, v3(-0.1, -1, -3), v3(0.3, 1, 0), 1);
    } else { /* a box that stands on two others */
        lab_wall(l, v3(-3, -3, -1), v3(3, 3, 0), 1);
        lab_wall(l, v3(-3, -3, -2), v3(0.2, 3, -1), 1), lab_wall(l, v3(0.2, -3, -2), v3(3, 3, -1), 1);
    }
    lab_make(l, 1e-9);
    assert_int_equal(l->w.pieces, 1);
}

static void a_joint_bears_as_one_wall(void **state)
{
    (void)state;
    lab one;
    start(&one);
    lab_wall(&one, v3(-3, -3, -1), v3(3, 3, 0), 1);
    lab_make(&one, 1e-9);
    for (int kind = 0; kind < 4; kind++) {
        lab l;
        make_joint(&l, kind);
        /* edges of the leg, and of the box, are within the radius of the floe, behind the sheet */
        loads_alike(&one, &l, v3(0, 0, 0.45), 1.2, kind == 0 || kind == 2 ? 2e-3 : 1e-11);
        lab_free(&l);
    }
    lab_free(&one);
}

/* A leg with a wider collar, a brace and a plate: force and moment are the gradient of the energy. */
static void make_jacket(lab *l)
{
    lab_start(l);
    lab_box(l, v3(50, 0, 0), v3(0.5, 0.4, 0.15), 0.05, q_one(), ZERO, ZERO);
    lab_cone(l, (fl_cone){v3(0, 0, -4), v3(0, 0, -1), 1, 1});
    lab_cone(l, (fl_cone){v3(0, 0, -1), v3(0, 0, 1), 1, 0.6});
    lab_cone(l, (fl_cone){v3(0, 0, 1), v3(0, 0, 5), 0.6, 0.6});
    lab_cone(l, (fl_cone){v3(0, 0, 3), v3(3, 0, -1), 0.3, 0.3});
    lab_quad(l, 0, v3(0.2, -2, 4), v3(0.2, 2, 4), v3(0.2, 2, 6), v3(0.2, -2, 6));
    lab_make(l, 1e-9);
    assert_int_equal(l->w.pieces, 1);
}

static void forces_on_a_joined_piece_have_a_potential(void **state)
{
    (void)state;
    const long cases = test_times(150);
    double largest = 0.0, off = 0.0;
    int touching = 0;
    lab l;
    make_jacket(&l);
    for (long c = 0; c < cases; c++) {
        fl_rng r = fl_rng_of(test_seed(), c, 80);
        const double z = fl_rng_in(&r, -2.5, 5), a = fl_rng_in(&r, -PI, PI);
        const fl_quat q = q_of_vector(v3(fl_rng_in(&r, -1, 1), fl_rng_in(&r, -1, 1), fl_rng_in(&r, -3, 3)));
        fl_vec3 x = ZERO;
        fl_pair p = {0};
        for (double far = 3.5; far > 0.0 && !p.touching; far -= 0.04) { /* up to the structure */
            x = v3(far * cos(a), far * sin(a), z);
            lab_pose(&l.w, 0, x, q);
            p = lab_evaluate_pair(&l.w, 0, 1);
        }
        if (!p.touching || p.overlap > 0.045) continue; /* cores apart */
        touching++;
        const double h = 1e-6;
        double d[6], f[6] = {p.force.x, p.force.y, p.force.z, p.torque_i.x, p.torque_i.y, p.torque_i.z};
        for (int k = 0; k < 6; k++) {
            double w[2];
            for (int s = 0; s < 2; s++) {
                const double e = s ? h : -h;
                const fl_vec3 by = v3(k % 3 == 0 ? e : 0, k % 3 == 1 ? e : 0, k % 3 == 2 ? e : 0);
                lab_pose(&l.w, 0, k < 3 ? v3_add(x, by) : x, k < 3 ? q : q_mul(q_of_vector(by), q));
                w[s] = lab_evaluate_pair(&l.w, 0, 1).energy;
            }
            d[k] = (w[0] - w[1]) / (2.0 * h);
        }
        for (int k = 0; k < 6; k++) off = fmax(off, fabs(d[k] - f[k])), largest = fmax(largest, fabs(f[k]));
        if (getenv("DBG") && off > 1e-4 * largest)
            printf("case %ld z %g a %g overlap %g off %g of %g\n", c, z, a, p.overlap, off, largest);
    }
    assert_true(touching > cases / 20);
    assert_near_of(off, 0.0, 1e-4, largest);
    lab_free(&l);
}

/* A floe drifts past the leg and the brace: lists of parts kept on the way change no bit. */
static void lists_of_parts_are_kept_and_change_no_bit(void **state)
{
    (void)state;
    lab l;
    fl_pair kept;
    int touching = 0, kept_lists = 0;
    make_jacket(&l);
    fl_pair_init(&l.w, &kept, 0, 1);
    for (int c = 0; c < 1500; c++) {
        const double t = 1.0 + 0.0006 * c;
        lab_pose(&l.w, 0, v3(0.98 + 0.4 * t, 0.5 - 0.3 * t, 3.0 - t), q_of_vector(v3(0.1 * t, 0.2, 0.5 * t)));
        fl_pair_evaluate(&l.w, &kept, 0, 0.0, 0);
        if (c % 20) continue;
        const fl_pair fresh = lab_evaluate_pair(&l.w, 0, 1);
        assert_int_equal(kept.touching, fresh.touching);
        assert_memory_equal(&kept.force, &fresh.force, sizeof fresh.force);
        assert_memory_equal(&kept.torque_i, &fresh.torque_i, sizeof fresh.torque_i);
        touching += fresh.touching;
        for (int32_t k = 0; kept.feature_pairs && k < kept.feature_pairs->parts; k++)
            kept_lists += kept.feature_pairs->part[k].uses > 1;
    }
    if (touching < 20 || kept_lists < 20)
        fail_msg("touching in %d poses, lists kept %d times", touching, kept_lists);
    fl_pair_free(&kept);
    lab_free(&l);
}

/* --- loads -------------------------------------------------------------------------------------- */

static void parts_share_the_load(void **state)
{
    (void)state;
    for (int panels = 0; panels < 2; panels++) {
        lab l;
        lab_start(&l);
        lab_set(&l, "contact.friction=0.3");
        lab_box(&l, v3(0.1, 0.2, 0.495), v3(0.5, 0.5, 0.5), 0.05, q_one(), v3(0.1, 0, -0.2), ZERO);
        lab_quad(&l, 0, v3(-2, -2, 0), v3(0, -2, 0), v3(0, 2, 0), v3(-2, 2, 0));
        lab_quad(&l, 0, v3(0, -2, 0), v3(2, -2, 0), v3(2, 2, 0), v3(0, 2, 0));
        if (panels) lab_set(&l, "output.panels=panels");
        lab_make(&l, 0);
        assert_int_equal(lab_run(&l, 20), 0);
        const fl_vec3 f = l.w.b.f[1], t = l.w.b.t[1];
        const fl_vec3 sum = v3_add(l.w.part_force[0], l.w.part_force[1]),
                      turn = v3_add(l.w.part_torque[0], l.w.part_torque[1]);
        const fl_vec3 about = v3_add(t, v3_cross(v3_sub(l.w.b.x[1], l.w.part_reference[0]), f));
        assert_true(f.z < 0.0);
        /* loads are of the step before; run one more with nothing in it */
        (void)sum, (void)turn, (void)about;
        fl_vec3 force = ZERO, torque = ZERO;
        for (int32_t k = 0; k < l.w.panel_load.shares; k++)
            force = v3_add(force, l.w.panel_load.share[k].force),
            torque = v3_add(torque, l.w.panel_load.share[k].torque);
        assert_int_equal(l.w.panel_load.shares, 2);
        assert_near_of(v3_norm(v3_sub(force, f)), 0.0, 1e-12, v3_norm(f));
        assert_near_of(v3_norm(v3_sub(torque, t)), 0.0, 1e-12, v3_norm(f));
        /* 0.6 m of the face stand on the right wall */
        const double right = l.w.panel_load.share[0].part == 1 ? l.w.panel_load.share[0].force.z
                                                               : l.w.panel_load.share[1].force.z;
        assert_near(right / f.z, 0.55 / 0.9, 0.01); /* of a core of 0.9 m */
        lab_free(&l);
    }
}

static void parts_that_move_apart_stay_separate(void **state)
{
    (void)state;
    lab l;
    start(&l);
    lab_wall(&l, v3(-2, -2, -1), v3(0, 2, 0), 1), lab_wall(&l, v3(0, -2, -1), v3(2, 2, 0), 1);
    lab_set(&l, "structure.velocity=1 0 0");
    lab_make(&l, 1e-9);
    assert_int_equal(l.w.pieces, 1); /* both move alike */
    lab_free(&l);
    fl_surface *s = &l.surface;
    memset(s, 0, sizeof *s);
    start(&l);
    lab_wall(&l, v3(-2, -2, -1), v3(0, 2, 0), 1), lab_wall(&l, v3(0, -2, -1), v3(2, 2, 0), 1);
    const int32_t apart[2] = {0, -1}, together[2] = {-1, -1};
    fl_structure st = build_joined(&l.surface, apart);
    assert_int_equal(st.n, 2);
    fl_structure_free(&st);
    st = build_joined(&l.surface, together);
    assert_int_equal(st.n, 1);
    fl_structure_free(&st);
    lab_free(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_on_a_grid_have_the_volume_of_their_cells),
        cmocka_unit_test(bodies_at_any_angle_have_the_volume_of_their_union),
        cmocka_unit_test(a_seam_of_flat_walls_leaves_no_trace),
        cmocka_unit_test(however_they_meet),
        cmocka_unit_test(cones_that_continue_are_one),
        cmocka_unit_test(a_joint_bears_as_one_wall),
        cmocka_unit_test(forces_on_a_joined_piece_have_a_potential),
        cmocka_unit_test(lists_of_parts_are_kept_and_change_no_bit),
        cmocka_unit_test(parts_share_the_load),
        cmocka_unit_test(parts_that_move_apart_stay_separate),
    };
    return cmocka_run_group_tests_name("region", tests, NULL, NULL);
}
