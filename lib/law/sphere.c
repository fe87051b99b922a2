/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/wide.h"
#include "law/sphere.h"
#include "law/tangent.h"

/* Registers are filled to the end: what stands behind the last contact is computed too, and not used. */
enum { FULL = 8 };
static int32_t filled(int32_t m) { return (m + FULL - 1) / FULL * FULL; }

/* No branches, so that the compiler puts several contacts side by side. */
#define SIDE_BY_SIDE _Pragma("omp simd")

FL_WIDE_VERSIONS static void stand(fl_spheres *restrict b, int32_t m)
{
    SIDE_BY_SIDE for (int32_t c = 0; c < m; c++)
    {
        const double x = b->d[0][c], y = b->d[1][c], z = b->d[2][c];
        const double d = sqrt(x * x + y * y + z * z), one = d > 0.0 ? 1.0 / d : 0.0;
        const double s = b->ri[c] + b->rj[c] - d, root = sqrt(s > 0.0 ? s : 0.0);
        b->n[0][c] = one * x;
        b->n[1][c] = one * y;
        b->n[2][c] = d > 0.0 ? one * z : 1.0;
        b->overlap[c] = s;
        b->elastic[c] = b->k[c] * (s * root);
        b->slope[c] = b->k[c] * (1.5 * root);
    }
}

FL_WIDE_VERSIONS static void rub(fl_spheres *restrict b, int32_t m, double dt)
{
    SIDE_BY_SIDE for (int32_t c = 0; c < m; c++)
    {
        const double nx = b->n[0][c], ny = b->n[1][c], nz = b->n[2][c], s = b->overlap[c];
        const double ux = b->u[0][c], uy = b->u[1][c], uz = b->u[2][c], elastic = b->elastic[c];
        const double closing = -(nx * ux + ny * uy + nz * uz), last = b->touch[c];
        const double now = closing > last ? closing : last, touch = now > 0.0 ? now : 0.0;
        const double stored2 = 2.0 * (0.4 * s * elastic) * b->invm[c], touch2 = touch * touch;
        const double speed = sqrt(stored2 > touch2 ? stored2 : touch2);
        const double chi = speed > 0.0 ? b->chi[c] / speed : 0.0;
        const double damped = elastic * (1.0 + chi * closing), normal = damped > 0.0 ? damped : 0.0;
        /* how the surfaces go by each other */
        const double ai = b->ri[c] - 0.5 * s, aj = b->rj[c] - 0.5 * s;
        const double wix = b->wi[0][c], wiy = b->wi[1][c], wiz = b->wi[2][c];
        const double wjx = b->wj[0][c], wjy = b->wj[1][c], wjz = b->wj[2][c];
        const double rx = ai * wix + aj * wjx, ry = ai * wiy + aj * wjy, rz = ai * wiz + aj * wjz;
        const double sx = ux - (ry * nz - rz * ny), sy = uy - (rz * nx - rx * nz),
                     sz = uz - (rx * ny - ry * nx);
        const double along = sx * nx + sy * ny + sz * nz;
        const double vx = sx - along * nx, vy = sy - along * ny, vz = sz - along * nz;
        const double twist = dt * (0.5 * ((wix + wjx) * nx + (wiy + wjy) * ny + (wiz + wjz) * nz));
        /* the remembered force turns about n, lies down in the tangent plane, and falls with the stiffness */
        const double px = b->slip[0][c], py = b->slip[1][c], pz = b->slip[2][c];
        const double tx = px + twist * (ny * pz - nz * py), ty = py + twist * (nz * px - nx * pz),
                     tz = pz + twist * (nx * py - ny * px);
        const double off = tx * nx + ty * ny + tz * nz;
        const double qx = tx - off * nx, qy = ty - off * ny, qz = tz - off * nz;
        const double before = sqrt(px * px + py * py + pz * pz), after = sqrt(qx * qx + qy * qy + qz * qz);
        const double k = b->tangential[c] * b->slope[c], old = b->stiff[c], limit = b->friction[c] * normal;
        const double had = before * (k < old ? k : 1.0), than = k < old ? old : 1.0,
                     share = had / (than * (after > 0.0 ? after : 1.0));
        const double way = (k < old ? k : 0.5 * (k + old)) * dt;
        const fl_grip from = {v3(share * qx, share * qy, share * qz), 0.0},
                      goes = {v3(-way * vx, -way * vy, -way * vz), 0.0};
        const double g = b->tangential[c] * chi * elastic;
        const fl_grip damps = {v3(-g * vx, -g * vy, -g * vz), 0.0};
        const fl_held rubs = fl_tangent_hold(from, share * after, goes, goes, limit, damps);
        const fl_vec3 e = rubs.kept.f, all = rubs.all.f;
        const int on = limit > 0.0 && b->tangential[c] > 0.0;
        b->touch[c] = touch;
        b->normal[c] = normal;
        b->slip[0][c] = on ? e.x : 0.0;
        b->slip[1][c] = on ? e.y : 0.0;
        b->slip[2][c] = on ? e.z : 0.0;
        b->stiff[c] = on ? k : 0.0;
        b->rub[0][c] = on ? all.x : 0.0;
        b->rub[1][c] = on ? all.y : 0.0;
        b->rub[2][c] = on ? all.z : 0.0;
    }
}

FL_WIDE_VERSIONS static void tell(fl_spheres *restrict b, int32_t m)
{
    SIDE_BY_SIDE for (int32_t c = 0; c < m; c++)
    {
        const double nx = b->n[0][c], ny = b->n[1][c], nz = b->n[2][c], f = b->normal[c];
        const double x = b->rub[0][c], y = b->rub[1][c], z = b->rub[2][c];
        const double tx = nz * y - ny * z, ty = nx * z - nz * x, tz = ny * x - nx * y; /* F_t x n */
        const double half = 0.5 * b->overlap[c], ai = b->ri[c] - half, aj = b->rj[c] - half;
        const double elastic = b->elastic[c], damping = f - elastic;
        b->push[0][c] = elastic * nx;
        b->push[1][c] = elastic * ny;
        b->push[2][c] = elastic * nz;
        b->damping[0][c] = damping * nx;
        b->damping[1][c] = damping * ny;
        b->damping[2][c] = damping * nz;
        b->ti[0][c] = ai * tx;
        b->ti[1][c] = ai * ty;
        b->ti[2][c] = ai * tz;
        b->tj[0][c] = aj * tx;
        b->tj[1][c] = aj * ty;
        b->tj[2][c] = aj * tz;
        b->size[c] = sqrt(f * f + (x * x + y * y + z * z));
    }
}

void fl_spheres_meet(fl_spheres *b, int32_t m, double dt)
{
    const int32_t full = filled(m);
    stand(b, full);
    rub(b, full, dt);
    tell(b, full);
}

void fl_spheres_place(fl_spheres *b, int32_t m)
{
    const int32_t full = filled(m);
    stand(b, full);
    tell(b, full);
}
