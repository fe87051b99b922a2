/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gpu/gpu_lists.h"
#include <math.h>
#include "world/access.h"

#define ROOM FL_GPU_ROOM
#define GET FL_GPU_GET
#define LAUNCH FL_GPU_LAUNCH

/* Cells are wider than the reach of the largest pair by more than rounding. */
#define CELL_MARGIN 1e-6

static double width_of_cells(const fl_world *w)
{
    double most = 0.0;
    for (int32_t k = 0; k < w->n; k++) most = fmax(most, w->b.radius[k]);
    return (2.0 * most + w->skin) * (1.0 + CELL_MARGIN);
}

/* Cells along a direction with a period; 0 without. */
static int32_t cells_along(double length, double width)
{
    return length > 0.0 ? (int32_t)fmin(floor(length / width), 1 << 20) : 0;
}

int fl_gpu_lists_apply(const fl_world *w)
{
    const double width = width_of_cells(w);
    const double L[3] = {w->cell.length.x, w->cell.length.y, w->cell.length.z};
    for (int32_t k = 0; k < w->n; k++)
        if (!w->b.is_isotropic[k]) return 0;
    for (int32_t a = 0; a < w->materials; a++)
        for (int32_t b = 0; b < w->materials; b++)
            if (!w->law[a * (w->materials + 2) + b].law->spheres) return 0;
    for (int e = 0; e < 3 && w->cell.periodic; e++)
        if (w->pieces || (L[e] > 0.0 && cells_along(L[e], width) < 3)) return 0;
    return w->bonds.n == 0 && width > 0.0;
}

static void set_cells(struct fl_gpu_world *g, const fl_world *w)
{
    fl_gpu_view *v = &g->v;
    const double width = width_of_cells(w);
    const int on = w->cell.periodic;
    const double L[3] = {on ? w->cell.length.x : 0.0, on ? w->cell.length.y : 0.0,
                         on ? w->cell.length.z : 0.0};
    v->skin = w->skin;
    for (int e = 0; e < 3; e++) {
        v->cells[e] = cells_along(L[e], width);
        v->cell_scale[e] = v->cells[e] ? v->cells[e] / L[e] : 1.0 / width;
    }
}

static int fail_engine(struct fl_gpu_world *g, int bad, fl_err *err) { return bad ? fl_gpu_fail(g, err) : 0; }

/* Offsets of the rows and links of each body; *rows, *links: of all. */
static int count_rows(struct fl_gpu_world *g, int32_t n, int32_t *rows, int32_t *links, fl_err *err)
{
    const int64_t ends = (int64_t)n + 1;
    if (ROOM(key, n) || ROOM(order, n) || ROOM(new_first, ends) || ROOM(new_link_first, ends) ||
        LAUNCH(KEYS, n) || fail_engine(g, g->e->sort(g->v.key, g->v.order, n), err) ||
        LAUNCH(COUNT_ROWS, n) ||
        fail_engine(g, g->e->offsets(g->v.new_first, n + 1) || g->e->offsets(g->v.new_link_first, n + 1),
                    err))
        return -1;
    return fl_gpu_get_bytes(g, rows, g->v.new_first + n, sizeof *rows, err) ||
                   fl_gpu_get_bytes(g, links, g->v.new_link_first + n, sizeof *links, err)
               ? -1
               : 0;
}

static int make_room(struct fl_gpu_world *g, const fl_world *w, int32_t rows, int32_t links, fl_err *err)
{
    return ROOM(new_row_i, rows) || ROOM(new_row_j, rows) || ROOM(new_row_law, rows) ||
                   ROOM(new_touches, rows) || ROOM(new_contact, rows) ||
                   (w->cell.periodic && ROOM(new_row_image, 3 * (int64_t)rows)) ||
                   (w->has_rolling && ROOM(new_rolling, rows)) || ROOM(lower, links) || ROOM(result, rows)
               ? -1
               : 0;
}

int fl_gpu_lists_make(struct fl_gpu_world *g, const fl_world *w, fl_err *err)
{
    int32_t rows = 0, links = 0;
    set_cells(g, w);
    if (count_rows(g, w->n, &rows, &links, err) || make_room(g, w, rows, links, err) ||
        LAUNCH(FILL_ROWS, w->n))
        return -1;
    FL_GPU_EXCHANGE(row_i, new_row_i);
    FL_GPU_EXCHANGE(row_j, new_row_j);
    FL_GPU_EXCHANGE(row_law, new_row_law);
    if (w->cell.periodic) FL_GPU_EXCHANGE(row_image, new_row_image);
    FL_GPU_EXCHANGE(touches, new_touches);
    FL_GPU_EXCHANGE(contact, new_contact);
    if (w->has_rolling) FL_GPU_EXCHANGE(rolling, new_rolling);
    FL_GPU_EXCHANGE(first, new_first);
    FL_GPU_EXCHANGE(link_first, new_link_first);
    g->v.rows = rows;
    g->has_listed |= rows > 0;
    g->rows_newer = 1;
    g->rows_dead = 0;
    return ROOM(link, links) || LAUNCH(LINK_ROWS, w->n) || LAUNCH(FORGET_ENDED, w->discs.n) ? -1 : 0;
}
