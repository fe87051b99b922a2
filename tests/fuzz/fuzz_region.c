/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Structures whose parts touch, intersect or coincide: whatever the surface, the pieces are joined or stay
 * apart, and a joined piece has sound indices. */
#include "mesh/gstruct.h"
#include "structure/region.h"
#include "support/fuzz.h"

/* Triangles above which a case would take long. */
enum { MANY = 3000 };

static int is_sound(const fl_structure *s)
{
    for (int32_t k = 0; k < s->n; k++) {
        const fl_piece *p = &s->piece[k];
        for (int32_t e = 0; e < p->core.ne; e++)
            if (p->core.edge[e].left >= p->core.nf || p->core.edge[e].right >= p->core.nf) return 0;
        for (int32_t f = 0; f < p->core.nf && p->mesh.cone_of_face; f++)
            if (p->mesh.cone_of_face[f] >= p->cones) return 0;
        if (p->several_parts && p->members < 2) return 0;
    }
    return 1;
}

static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_surface surface = {0};
    fl_structure s = {0};
    int rc = fl_gstruct_read(&surface, fuzz_file(data, n), &err), many = 0, sound = 1;
    for (int32_t k = 0; k < surface.n; k++) many += surface.part[k].nt + 200 * surface.part[k].nc;
    if (rc == 0 && many < MANY) {
        rc = fl_structure_build(&s, &surface, &err) || fl_regions_join(&s, &surface, NULL, v3(0, 0, 0), &err)
                 ? -1
                 : 0;
        sound = rc || is_sound(&s);
    }
    fl_structure_free(&s);
    fl_surface_free(&surface);
    return sound ? fuzz_verdict(rc, &err) : FUZZ_BROKEN;
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "region", fuzz_one); }
