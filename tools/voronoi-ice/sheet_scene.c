/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sheet_scene.h"
#include "base/number_text.h"
#include "base/stream.h"

/* Strength and stiffness where none is asked for, as in the table of keys. */
#define DEFAULT_STRENGTH 0.7e6

/* Strain at which bonds may break at most: the tables are of small strains, 1e-3 in their samples. */
#define MOST_STRAIN 0.01

/* Least strength and modulus of any ice, that of models included; below, a unit was forgotten [Pa]. */
#define LEAST_STRENGTH 1e3
#define LEAST_YOUNG 1e5

static int check_stress(const char *option, double x, double least, const char *example, fl_err *err)
{
    if (x == 0.0 || x >= least) return 0;
    return fl_fail(err, FL_USAGE, "--%s is %g Pa, which no ice has: at least %g Pa, as %s, is expected",
                   option, x, least, example);
}

int sheet_bonds_choose(struct sheet_bonds *out, const struct recipe *o, enum fl_packing_kind kind,
                       fl_err *err)
{
    *out = (struct sheet_bonds){0};
    if (o->flexural > 0.0 && o->compressive > 0.0)
        return fl_fail(
            err, FL_USAGE,
            "--flexural and --compressive both set the strength of the bonds, one of them is expected");
    if (o->flexural == 0.0 && o->compressive == 0.0 && o->young == 0.0) return 0;
    if (!o->bonded || !o->scene)
        return fl_fail(
            err, FL_USAGE,
            "--flexural, --compressive and --young set the bonds of --scene FILE: --bonded and --scene are "
            "expected");
    if (check_stress("flexural", o->flexural, LEAST_STRENGTH, "0.5MPa", err) ||
        check_stress("compressive", o->compressive, LEAST_STRENGTH, "2MPa", err) ||
        check_stress("young", o->young, LEAST_YOUNG, "1GPa", err))
        return -1;
    out->ratio = fl_sheet_strength_of(kind, o->layers, o->rows_across);
    out->turned = fl_sheet_strength_of(kind, o->layers, !o->rows_across);
    if (o->flexural > 0.0) out->strength = o->flexural / out->ratio.flexural;
    if (o->compressive > 0.0 && out->ratio.compressive == 0.0)
        return fl_fail(err, FL_USAGE,
                       "--compressive: a cubic lattice that is pressed along its rows does not fail, "
                       "--flexural or another --lattice is expected");
    if (o->compressive > 0.0) out->strength = o->compressive / out->ratio.compressive;
    if (o->young > 0.0) out->young = o->young / out->ratio.young;
    /* The modulus that is expected is printed with three digits, so 0.5 % more of it is enough. */
    if (out->young > 0.0 && out->strength > MOST_STRAIN * out->young)
        return fl_fail(
            err, FL_USAGE,
            "%s: bonds of %.3g Pa that would break at a strain of %.2g, which the tables of strength "
            "do not reach: a --young of at least %.3g Pa is expected",
            o->flexural > 0.0 ? "--flexural" : "--compressive", out->strength, out->strength / out->young,
            1.005 * out->strength / MOST_STRAIN * out->ratio.young);
    return 0;
}

static void write_value(FILE *f, const char *key, double x, const char *unit)
{
    char text[FL_NUMBER_LEN];
    fprintf(f, "%s = %s%s%s\n", key, fl_number_text(x, text), *unit ? " " : "", unit);
}

static void write_inflow(FILE *f, const struct sheet_inflow *p)
{
    char text[FL_NUMBER_LEN];
    fl_number_text(p->bound, text);
    fprintf(f, "\n[boundary]\ntype = free\n%s = %s %s none\n", p->backwards ? "max" : "min",
            p->along_y ? "none" : text, p->along_y ? text : "none");
    fprintf(f, "inflow = ice\ninflow_from = %s%s\n", p->backwards ? "" : "-", p->along_y ? "y" : "x");
    write_value(f, "inflow_pitch", p->pitch, "m");
    if (p->speed > 0.0) write_value(f, "inflow_speed", p->speed, "m/s");
}

int sheet_scene_write(const struct recipe *o, const struct sheet_bonds *bonds, double slab,
                      const struct sheet_inflow *inflow, const fl_history_line *by, fl_err *err)
{
    fl_out file = {0};
    if (fl_out_open(&file, o->scene, 0, err)) return -1;
    FILE *const f = file.f;
    fprintf(f, "%s\n[ice]\n", by->text);
    write_value(f, "slab", slab, "m");
    fprintf(f, "\n[material %s]\n", o->material);
    write_value(f, "density", o->ice_density, "kg/m3");
    if (bonds->young > 0.0) write_value(f, "young", bonds->young, "Pa");
    fprintf(f, "\n[water]\n");
    write_value(f, "density", o->water_density, "kg/m3");
    if (o->bonded) {
        const double c = bonds->strength > 0.0 ? bonds->strength : DEFAULT_STRENGTH;
        fprintf(f, "\n[bond]\non = true\n");
        if (bonds->young > 0.0) write_value(f, "young", bonds->young, "Pa");
        write_value(f, "poisson", FL_SHEET_POISSON, "");
        write_value(f, "normal_strength", c, "Pa");
        write_value(f, "shear_strength", c, "Pa");
        fprintf(f, "softening = stretch\nstretch = 1.5\ndamping = 0.1\n");
        write_value(f, "scatter", FL_SHEET_SCATTER, "");
    }
    fprintf(f, "\n[contact]\nround_law = linear\n");
    write_value(f, "tangential_ratio", 0.5 / (1.0 + FL_SHEET_POISSON), "");
    if (inflow) write_inflow(f, inflow);
    return fl_out_close(&file, err);
}
