/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh/read_gdf.h"
#include <math.h>
#include <string.h>
#include "mesh/panel_mesh.h"

int fl_gdf_is(const fl_bytes *b)
{
    char word[2][FL_PANEL_WORD];
    double x;
    int64_t i, j;
    const char *p = fl_panel_next_line(b->data);
    if (!fl_bytes_is_text(b) || fl_panel_head_words(p, 2, word) < 2 || !fl_panel_is_real(word[0], &x))
        return 0;
    const int list = x < 0.0; /* of bodies */
    if (!fl_panel_is_real(word[1], &x)) return 0;
    p = fl_panel_next_line(p);
    const int n = fl_panel_head_words(p, 2, word);
    if (list) return n >= 1 && fl_panel_is_integer(word[0], &i) && i > 0;
    if (n < 2 || !fl_panel_is_integer(word[0], &i) || !fl_panel_is_integer(word[1], &j) || i < -1 || i > 1 ||
        j < -1 || j > 1)
        return 0;
    p = fl_panel_next_line(p);
    return fl_panel_head_words(p, 1, word) >= 1 && fl_panel_is_integer(word[0], &i) && i > 0;
}

/* GRAV tells the unit of length: m/s2, ft/s2 or mm/s2. */
static void hint_gravity(fl_bytes *b, const fl_import_options *opt, double g)
{
    if (opt && opt->has_unit) return;
    if (g > 32.0 && g < 32.4) fl_bytes_note(b, "GRAV %g speaks of feet: --unit ft", g);
    else if (g > 9700.0 && g < 9900.0) fl_bytes_note(b, "GRAV %g speaks of millimetres: --unit mm", g);
}

/* A row that must be there. */
static int need_row(fl_bytes *b, const char *what, fl_err *err)
{
    const int more = fl_bytes_row(b, err);
    return more > 0 ? 0 : more < 0 ? -1 : fl_bytes_fail(b, err, "the file ends where %s is expected", what);
}

static int read_header(fl_bytes *b, fl_panel_mesh *m, fl_import_options *opt, int64_t *panels, fl_err *err)
{
    double length, gravity;
    int64_t s[2], order = 0;
    char *title;
    int32_t len;
    if (fl_bytes_line(b, &title, &len, err) < 0 || need_row(b, "ULEN GRAV", err) ||
        fl_panel_real(b, 0, "ULEN", &length, err) || fl_panel_real(b, 1, "GRAV", &gravity, err))
        return -1;
    if (length < 0.0)
        return fl_bytes_fail(b, err, "ULEN %g: a list of bodies: read their files one by one", length);
    if (need_row(b, "ISX ISY", err) || fl_panel_integer(b, 0, "ISX", &s[0], err) ||
        fl_panel_integer(b, 1, "ISY", &s[1], err) || need_row(b, "NPAN", err) ||
        fl_panel_integer(b, 0, "NPAN", panels, err))
        return -1;
    if (b->words > 1 && fl_panel_is_integer(b->field[1], &order) && order != 0)
        return fl_bytes_fail(b, err, "higher-order geometry (IGDEF %lld): save it as flat panels",
                             (long long)order);
    hint_gravity(b, opt, gravity);
    for (int k = 0; k < 2; k++) {
        if (s[k] == 1) m->planes[0] |= (int8_t)(1 << k);
        if (s[k] == -1)
            fl_bytes_note(b, "IS%c -1 is a wall in %c = 0, which mirrors nothing", "XY"[k], "xy"[k]);
    }
    return 0;
}

static int read_corners(fl_bytes *b, fl_panel_mesh *m, int64_t panels, fl_err *err)
{
    b->line++; /* numbers follow on the next line */
    for (int64_t i = 0; i < panels; i++) {
        int32_t v[4];
        for (int k = 0; k < 4; k++) {
            double x[3] = {0};
            for (int c = 0; c < 3; c++) {
                const int more = fl_bytes_real(b, 0, &x[c], err);
                if (more < 0) return -1;
                if (more == 0)
                    return fl_bytes_fail(b, err, "NPAN promises %lld panels, the file ends in panel %lld",
                                         (long long)panels, (long long)i + 1);
            }
            if ((v[k] = fl_panel_mesh_vertex(m, v3(x[0], x[1], x[2]), err)) < 0) return -1;
        }
        if (fl_panel_mesh_add(m, 0, v, err)) return -1;
    }
    return 0;
}

int fl_gdf_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    fl_panel_mesh m = {.b = b};
    int64_t panels, dipoles;
    int rc = -1, more;
    (void)name;
    b->fortran = 1;
    if (fl_panel_mesh_body(&m, "hull", err) < 0 || read_header(b, &m, opt, &panels, err) ||
        read_corners(b, &m, panels, err))
        goto done;
    b->words = b->next = 0;
    while ((more = fl_bytes_row(b, err)) > 0 && b->words > 1)
        if (strncmp(b->field[1], "NPAND", 5) == 0 && fl_panel_is_integer(b->field[0], &dipoles) &&
            dipoles > 0)
            fl_bytes_note(b, "%lld dipole panels were passed over", (long long)dipoles);
    rc = more < 0 ? -1 : fl_panel_mesh_finish(&m, s, err);
done:
    fl_panel_mesh_free(&m);
    return rc;
}
