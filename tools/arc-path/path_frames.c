/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "path_frames.h"
#include "geom/aabb.h"
#include "out/frames.h"
#include "structure/member_motion.h"

/* Radius of members whose section has none, over the diagonal of the model. */
static const double THIN = 0.004;

int path_frames_begin(struct path_frames *f, const struct options *o, const fl_member_model *m, fl_err *err)
{
    const fl_bodies none = {.n = 0};
    const fl_poses poses = {.b = &none};
    fl_history_line by;
    fl_aabb box = aabb_empty();
    for (int32_t k = 0; k < m->node_name.n; k++) box = aabb_join(box, (fl_aabb){m->node[k].x, m->node[k].x});
    if (fl_member_motion_frames_surface(&f->surface, m, THIN * v3_norm(v3_sub(box.hi, box.lo)), err) ||
        fl_out_open(&f->out, o->frames, 0, err))
        return -1;
    f->open = 1;
    options_by(o, &by);
    fl_frames_header(f->out.f, NULL, &by, &poses, &f->surface, NULL);
    return 0;
}

void path_frames_point(struct path_frames *f, const fl_member_chain *c, int64_t number)
{
    const fl_bodies none = {.n = 0};
    const fl_poses poses = {.b = &none};
    if (!f->open) return;
    fl_frames_frame(f->out.f, (double)number, &poses, v3(0, 0, 0), 1);
    for (int32_t k = 0; k < c->contacts; k++) {
        fl_vec3 x;
        fl_quat q;
        fl_member_motion_chain_pose(c, k, &x, &q);
        fl_frames_part_pose(f->out.f, f->surface.part[k].id, x, q);
    }
}

int path_frames_end(struct path_frames *f, int keep, fl_err *err)
{
    int rc = 0;
    if (f->open && keep) rc = fl_out_close(&f->out, err);
    fl_out_abort(&f->out);
    fl_surface_free(&f->surface);
    f->open = 0;
    return rc;
}
