/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "member/imperfection.h"
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/rng.h"
#include "base/table.h"

void fl_member_scatter(fl_member_model *m, double a, uint64_t seed)
{
    for (int32_t k = 0; k < m->node_name.n; k++) {
        fl_rng g = fl_rng_of(seed, k, FL_RNG_OFFSET);
        fl_member_node *n = &m->node[k];
        const double x = a * fl_rng_normal(&g), y = a * fl_rng_normal(&g), z = a * fl_rng_normal(&g);
        n->offset =
            v3_add(n->offset, v3(n->fixed & 1 ? 0.0 : x, n->fixed & 2 ? 0.0 : y, n->fixed & 4 ? 0.0 : z));
    }
}

static int read_shape(const fl_member_model *m, const char *path, fl_vec3 *d, fl_err *err)
{
    static const char *const name[] = {"node", "dx", "dy", "dz"};
    fl_table t = {0};
    int32_t col[4];
    int more = 1, rc = fl_table_open(&t, path, "shape", 1, err);
    for (int k = 0; k < 4 && rc == 0; k++) rc = fl_table_require(&t, name[k], &col[k], err);
    while (rc == 0 && (more = fl_table_row(&t, err)) > 0) {
        const int32_t n = fl_string_table_find(&m->node_name, fl_table_word(&t, col[0]));
        double x[3];
        if (n < 0) {
            rc = fl_text_fail(&t.text, err, "%s has no node %.60s", m->file, fl_table_word(&t, col[0]));
            break;
        }
        for (int k = 0; k < 3 && rc == 0; k++) rc = fl_table_f64_bounded(&t, col[k + 1], 1e60, &x[k], err);
        if (rc == 0) d[n] = v3(x[0], x[1], x[2]);
    }
    if (more < 0) rc = -1;
    fl_table_close(&t);
    return rc;
}

int fl_member_add_shape(fl_member_model *m, const char *path, double a, fl_err *err)
{
    fl_vec3 *d = fl_alloc(m->node_name.n, sizeof *d, err);
    double most = 0.0;
    int rc = d ? read_shape(m, path, d, err) : -1;
    for (int32_t k = 0; k < m->node_name.n && rc == 0; k++) most = fmax(most, v3_norm(d[k]));
    if (rc == 0 && !(most > 0.0)) rc = fl_fail(err, FL_INPUT, "%s: no node is displaced", path);
    for (int32_t k = 0; k < m->node_name.n && rc == 0; k++)
        m->node[k].offset = v3_madd(m->node[k].offset, a / most, d[k]);
    free(d);
    return rc;
}

void fl_member_write_shape(FILE *f, const fl_member_model *m, const fl_member_chain *c)
{
    char text[FL_NUMBER_LEN];
    fputs("#shape 1\nnode\tx\ty\tz\tdx\tdy\tdz\n", f);
    for (int32_t k = 0; k < c->nodes; k++) {
        const fl_member_ball *b = &c->ball[k];
        const double x[] = {b->x0.x, b->x0.y, b->x0.z, b->d.x, b->d.y, b->d.z};
        fputs(m->node_name.name[k], f);
        for (int i = 0; i < 6; i++) fprintf(f, "\t%s", fl_number_text(x[i], text));
        putc('\n', f);
    }
}
