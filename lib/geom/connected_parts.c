/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include "base/union_find.h"
#include "geom/edges.h"
#include "geom/connected_parts.h"

int fl_part_connected(const fl_part *p, int32_t *shell, int32_t *odd, fl_err *err)
{
    fl_edges e;
    *odd = 0;
    if (fl_edges_make(&e, p, err)) return -1;
    for (int32_t t = 0; t < p->nt; t++) shell[t] = t;
    for (int32_t v = 0; v < p->nv; v++)
        for (int64_t from = e.first[v], to; from < e.first[v + 1]; from = to) {
            to = fl_edge_end(&e, v, from);
            const int single = (to - from) % 2 != 0;
            *odd += single;
            for (int64_t k = from; k < to && !single; k += 2)
                fl_union_find_join(shell, e.side[k].t, e.side[k + 1].t);
        }
    for (int32_t t = 0; t < p->nt; t++) shell[t] = fl_union_find_root(shell, t);
    fl_edges_free(&e);
    return 0;
}
