/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pack_run.h"
#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "base/output_guard.h"
#include "base/parallel.h"
#include "base/pi.h"
#include "base/stream.h"
#include "pack/pack_passage.h"
#include "pack/packing_state.h"
#include "pack_plot.h"
#include "pack_report.h"

/* A packing that jams has the porosity asked where the solid part is nearer than this. */
static const double SOLID_TOL = 1e-3;

static volatile sig_atomic_t stop_signal;
static void note_signal(int number)
{
    stop_signal = number;
    signal(number, SIG_DFL); /* a second one ends the program at once */
}

/* --- bodies ------------------------------------------------------------------------------------- */

/* Volume of a body of size 1: of discs the area, of several shapes the mean. */
static double unit_volume(const struct result *r, int dim)
{
    double sum = 0.0;
    if (dim == 2) return PI / 4.0;
    for (int32_t k = 0; k < r->shapes.n; k++) sum += r->shapes.shape[k].volume / r->shapes.n;
    return sum;
}

static int read_layers(const struct options *o, struct result *r, fl_err *err)
{
    for (int k = 0; k < o->layer_count; k++)
        if (fl_pack_layers_add(&r->layers, o->layer[k], o->dim, o->straight == STRAIGHT_LINEAR, err))
            return -1;
    if (!o->grading) return 0;
    r->others = r->grading; /* that of all bodies is known when the parts are */
    r->grading = (fl_grading){0};
    return 0;
}

static int read_grading(const struct options *o, struct result *r, fl_err *err)
{
    if (!o->grading && o->layer_count) return read_layers(o, r, err);
    const char *text = o->grading ? o->grading : "single:1";
    const int law = fl_grading_law(&r->grading, text, o->dim, err);
    if (law < 0) return -1;
    if (law == 0 && fl_grading_read(&r->grading, text, o->straight == STRAIGHT_LINEAR, err)) return -1;
    const int listed = r->grading.n > 0, target = o->number > 0 || !isnan(options_solid(o));
    if (listed && target)
        return fl_fail(
            err, FL_USAGE,
            "--grading %.60s lists the sizes of all bodies, no --porosity, --solid or --number is expected",
            text);
    if (!listed && !target)
        return fl_fail(err, FL_USAGE, "one of --porosity, --solid and --number is expected");
    return o->layer_count ? read_layers(o, r, err) : 0;
}

/* Bodies too large for the region are refused before any is drawn. */
static int check_largest(const struct options *o, const struct result *r, fl_err *err)
{
    double thin = 0.0;
    for (int32_t k = 0; k < r->shapes.n; k++) {
        const fl_vec3 h = r->shapes.shape[k].half;
        thin = fmax(thin, fmin(h.x, fmin(h.y, h.z)));
    }
    const double d = fl_grading_most(&r->grading);
    fl_passage narrow;
    if (d * thin > r->region.inradius * (1.0 + 1e-9))
        return fl_fail(
            err, FL_INPUT,
            "%s: the largest body of %.6g m does not fit: the region takes a ball of %.6g m at most%s", o->in,
            d, 2.0 * r->region.inradius, fl_region_is_periodic(&r->region) ? " (half of a period)" : "");
    if (fl_passage_find(&narrow, &r->region, d * thin, err)) return -1;
    if (!narrow.found) return 0;
    return fl_fail(
        err, FL_INPUT,
        "%s: the largest body of %.6g m does not pass the narrowest passage of the region, about %.2g m "
        "wide near (%.6g, %.6g, %.6g): pack its parts one by one",
        o->in, d, narrow.width, narrow.at.x, narrow.at.y, narrow.at.z);
}

static int draw_bodies(const struct options *o, struct result *r, fl_err *err)
{
    double *size = NULL;
    int32_t n;
    const double volume = isnan(r->asked) ? 0.0 : r->asked * r->region.volume, v = unit_volume(r, o->dim);
    if (r->layers.n ? fl_pack_layers_draw(&r->layers, o->dim, v, volume, &size, &n, &r->empty, err)
                    : fl_grading_draw(&r->grading, o->dim, v, volume, o->number, &size, &n, &r->empty, err))
        return -1;
    int rc = fl_packing_make(&r->packing, o->dim, n, size, &r->shapes, o->seed, err);
    free(size);
    if (rc == 0 && !isnan(r->asked)) { /* several shapes differ from their mean */
        fl_packing *p = &r->packing;
        const double scale = pow(volume / fl_packing_volume(p, 1.0, 0), 1.0 / o->dim);
        for (int32_t i = 0; i < n; i++) p->size[i] *= scale, p->radius[i] *= scale, p->bound[i] *= scale;
    }
    return rc;
}

/* --- growth ------------------------------------------------------------------------------------- */

static void report_progress(const struct options *o, const struct result *r, const char *phase, double left)
{
    const int terminal = isatty(2) && !o->quiet;
    const fl_overlap_totals *t = &r->overlaps.now;
    if (o->verbose)
        fprintf(stderr, "%s: scale %.6f, overlap %.2g, %.3f contacts a body, %lld steps\n", phase,
                r->packing.s, t->max_overlap, 2.0 * (double)t->contacts / r->packing.n,
                (long long)r->overlaps.steps);
    else if (terminal)
        fprintf(stderr, "\r%s: scale %.4f, %.0f %% left   ", phase, r->packing.s, 100.0 * left);
}

static void end_progress(const struct options *o)
{
    if (!o->verbose && !o->quiet && isatty(2))
        fputs("\r                                                  \r", stderr);
}

static fl_growth_options growth_options(const struct options *o)
{
    fl_growth_options g = fl_growth_defaults();
    g.trim = (enum fl_growth_trim)o->trim;
    g.layers = o->layers;
    return g;
}

static int grow_relaxed(const struct options *o, struct result *r, fl_err *err)
{
    const fl_growth_options g = growth_options(o);
    while (r->growth.phase != FL_GROWTH_DONE) {
        const int phase = r->growth.phase;
        if (stop_signal || (o->until > 0.0 && phase == FL_GROWTH_RISE && r->packing.s >= o->until)) {
            r->stopped = 1;
            return 0;
        }
        if (fl_growth_stage(&r->growth, &r->overlaps, &g, err)) return -1;
        report_progress(o, r, fl_growth_phase_name[phase],
                        phase == FL_GROWTH_RISE ? 2.0 * (1.0 - r->packing.s) : 0.0);
    }
    return 0;
}

struct moving {
    const struct options *o;
    const struct result *r;
    const char *phase;
};

static int note_motion(void *with, const fl_packing *p, const fl_pack_moved *m)
{
    const struct moving *w = with;
    (void)p;
    if (w->o->verbose)
        fprintf(stderr, "%s: scale %.6f, %lld steps, %.4g s, speed %.2g\n", w->phase, w->r->packing.s,
                (long long)m->steps, m->time, m->speed);
    else report_progress(w->o, w->r, w->phase, 2.0 * (1.0 - w->r->packing.s));
    return stop_signal != 0;
}

static fl_pack_motion motion_of(const struct options *o)
{
    return (fl_pack_motion){.gravity = o->gravity,
                            .friction = o->friction,
                            .restitution = o->restitution,
                            .young = o->young,
                            .density = o->density,
                            .rest = 1e-3};
}

/* By steps with friction; what overlap is left of a packing that is not jammed is relaxed.  Without friction
 * relaxation goes on from where the steps jam. */
static int grow_moving(const struct options *o, struct result *r, fl_err *err)
{
    const fl_pack_motion m = motion_of(o);
    struct moving w = {o, r, "growth"};
    /* bodies that were thrown onto each other would burst apart */
    if (o->throwing == FL_THROW_POISSON && fl_overlaps_relax(&r->overlaps, 1e-3, 1e-4, 20000, err) < 0)
        return -1;
    if (fl_pack_grow_moving(&r->packing, &r->region, &m, &r->overlaps, note_motion, &w, &r->moved, err))
        return -1;
    if (r->moved.jammed && o->friction > 0.0) {
        r->growth.jammed = 1;
        r->growth.jam_scale = r->moved.jam_scale;
        r->growth.phase = FL_GROWTH_DONE;
    } else if (r->packing.s >= 1.0) {
        r->growth.phase = FL_GROWTH_SETTLE;
    }
    return grow_relaxed(o, r, err);
}

static int come_to_rest(const struct options *o, struct result *r, fl_err *err)
{
    const fl_pack_motion m = motion_of(o);
    struct moving w = {o, r, "rest"};
    if (fl_pack_settle(&r->packing, &r->region, &m, note_motion, &w, &r->rest, err)) return -1;
    r->overlaps.stale = 1;
    return fl_overlaps_evaluate(&r->overlaps, err);
}

/* --- files -------------------------------------------------------------------------------------- */

static int check_files(const struct options *o, fl_err *err)
{
    const fl_named_path out[] = {
        {"--output", o->out}, {"--certificate", o->certificate}, {"--checkpoint", o->checkpoint}};
    const fl_named_path in[] = {
        {.path = strchr(o->in, ':') ? NULL : o->in},
        {.path = o->grading && !strchr(o->grading, ':') ? o->grading : NULL},
        {.path = strcmp(o->shapes, "sphere") && !strchr(o->shapes, ':') ? o->shapes : NULL}};
    return fl_output_guard_check(out, 3, in, 3, err);
}

/* Of all that a state depends on. */
static uint64_t hash_of(const struct options *o, const struct result *r)
{
    fl_history_line by;
    uint64_t h = FL_HASH_START;
    options_by(o, &by);
    h = fl_hash(h, by.text, by.len);
    h = fl_hash(h, &r->region.volume, sizeof r->region.volume);
    h = fl_hash(h, &r->packing.n, sizeof r->packing.n);
    h = fl_hash(h, r->layers.part, (int64_t)sizeof r->layers.part);
    for (int32_t k = 0; k < r->region.features; k++)
        h = fl_hash(h, r->region.feature[k].p, (int64_t)sizeof r->region.feature[k].p);
    return h;
}

static int write_bodies(const struct options *o, const struct result *r, const fl_history_line *by,
                        fl_err *err)
{
    fl_ice_field field = {0};
    fl_out out = {0};
    int rc = fl_packing_field(&r->packing, o->material, o->group, &field, err);
    if (rc == 0) rc = fl_out_open(&out, o->out, o->gzip, err);
    if (rc == 0) {
        fl_ice_field_write(out.f, &field, by);
        rc = fl_out_close(&out, err);
    }
    fl_out_abort(&out);
    fl_ice_field_free(&field);
    return rc;
}

static int write_all(const struct options *o, struct result *r, fl_err *err)
{
    fl_history_line by;
    options_by(o, &by);
    for (int32_t k = 0; k <= r->layers.n && r->layers.n; k++)
        if (fl_packing_layer_measure(&r->layer[k], &r->packing, &r->layers, k, err)) return -1;
    if (fl_packing_certify(&r->certificate, &r->overlaps, options_graded(o) ? &r->grading : NULL, err))
        return -1;
    if (write_bodies(o, r, &by, err)) return -1;
    if (o->certificate && report_write(o, r, &by, err)) return -1;
    if (!o->quiet) report_print(o, r);
    return o->plot ? pack_plot(o, r, &by, err) : 0;
}

/* The answer: whether the porosity asked was reached. */
static int answer(const struct result *r, fl_err *err)
{
    const fl_packing_certificate *c = &r->certificate;
    if (!r->growth.jammed || isnan(r->asked) || fabs(c->solid - r->asked) <= SOLID_TOL) return 0;
    return fl_fail(err, FL_NO,
                   "no packing has the porosity %.6g: the bodies jam at %.6g, radii are %.6g of those asked",
                   1.0 - r->asked, 1.0 - c->solid, r->packing.s);
}

static int prepare(const struct options *o, struct result *r, fl_err *err)
{
    if (check_files(o, err) || fl_pack_shapes_make(&r->shapes, o->shapes, err) || read_grading(o, r, err) ||
        fl_region_make(&r->region, o->in, o->dim, o->periodic, err) ||
        fl_region_set_helpers(&r->region, o->helper, err) ||
        (r->layers.n &&
         fl_pack_layers_measure(&r->layers, &r->region, o->grading ? &r->others : NULL, &r->grading, err)) ||
        check_largest(o, r, err))
        return -1;
    if (o->gravity > 0.0 && r->region.kind == FL_REGION_SPHERE)
        return fl_fail(err, FL_USAGE, "--gravity in sphere:..., a box, a cylinder or a file is expected");
    if (o->grow == GROW_DYNAMIC && r->region.kind == FL_REGION_SPHERE)
        return fl_fail(err, FL_USAGE,
                       "--grow dynamic in sphere:..., a box, a cylinder or a file is expected");
    r->asked = options_solid(o);
    if (draw_bodies(o, r, err)) return -1;
    if (o->plot && mkdir(o->plot, 0777) != 0 && errno != EEXIST)
        return fl_fail(err, FL_SYSTEM, "%s: %s", o->plot, strerror(errno));
    return 0;
}

static int start(const struct options *o, struct result *r, fl_err *err)
{
    const fl_growth_options g = growth_options(o);
    r->growth = fl_growth_start(&g);
    if (o->resume) {
        if (fl_packing_state_read(&r->packing, &r->growth, hash_of(o, r), o->resume, err)) return -1;
    } else if (fl_throw_bodies(&r->packing, &r->region, r->layers.n ? &r->layers : NULL,
                               (enum fl_throw)o->throwing, o->seed, &r->halved, err) ||
               fl_packing_sort(&r->packing, err)) {
        return -1;
    }
    return fl_overlaps_make(&r->overlaps, &r->packing, &r->region, err);
}

static int run_all(const struct options *o, struct result *r, fl_err *err)
{
    if (prepare(o, r, err) || start(o, r, err)) return -1;
    signal(SIGINT, note_signal);
    signal(SIGTERM, note_signal);
    if (o->grow == GROW_RELAX ? grow_relaxed(o, r, err) : grow_moving(o, r, err)) return -1;
    if (r->stopped) {
        end_progress(o);
        if (o->checkpoint &&
            fl_packing_state_write(&r->packing, &r->growth, hash_of(o, r), o->checkpoint, err))
            return -1;
        return stop_signal ? fl_fail(err, FL_NO, "stopped by a signal at scale %.6g%s", r->packing.s,
                                     o->checkpoint ? ", the checkpoint is written" : "")
                           : 0;
    }
    if (o->gravity > 0.0 && !stop_signal && come_to_rest(o, r, err)) return -1;
    end_progress(o);
    if (stop_signal) return fl_fail(err, FL_NO, "stopped by a signal after growth");
    return write_all(o, r, err) || answer(r, err) ? -1 : 0;
}

int pack_run(const struct options *o, fl_err *err)
{
    struct result *r = calloc(1, sizeof *r);
    if (!r) return fl_fail(err, FL_SYSTEM, "out of memory");
    const int rc = run_all(o, r, err);
    fl_overlaps_free(&r->overlaps);
    fl_packing_free(&r->packing);
    fl_pack_shapes_free(&r->shapes);
    fl_grading_free(&r->grading);
    fl_grading_free(&r->others);
    fl_pack_layers_free(&r->layers);
    fl_region_free(&r->region);
    free(r);
    return rc;
}
