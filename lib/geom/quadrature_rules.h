/* SPDX-License-Identifier: GPL-3.0-or-later */
/* quadrature_rules.h -- nodes and weights of numerical integration over a triangle and over [0, 1]. */
#ifndef FL_GEOM_QUADRATURE_RULES_H
#define FL_GEOM_QUADRATURE_RULES_H

/* Nodes of a triangle in barycentric coordinates, weights for the mean; exact for polynomials of degree 5:
 * the centroid and two triples (1 - 2a, a, a).  Dunavant, Int. J. Numer. Meth. Eng. 21 (1985) 1129. */
enum { FL_TRIANGLE_NODES = 7 };
#define FL_TRIANGLE_A 0.47014206410511508977
#define FL_TRIANGLE_B 0.10128650732345633880
static const double FL_TRIANGLE_NODE[FL_TRIANGLE_NODES][3] = {
    {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0},
    {1.0 - 2.0 * FL_TRIANGLE_A, FL_TRIANGLE_A, FL_TRIANGLE_A},
    {FL_TRIANGLE_A, 1.0 - 2.0 * FL_TRIANGLE_A, FL_TRIANGLE_A},
    {FL_TRIANGLE_A, FL_TRIANGLE_A, 1.0 - 2.0 * FL_TRIANGLE_A},
    {1.0 - 2.0 * FL_TRIANGLE_B, FL_TRIANGLE_B, FL_TRIANGLE_B},
    {FL_TRIANGLE_B, 1.0 - 2.0 * FL_TRIANGLE_B, FL_TRIANGLE_B},
    {FL_TRIANGLE_B, FL_TRIANGLE_B, 1.0 - 2.0 * FL_TRIANGLE_B}};
static const double FL_TRIANGLE_WEIGHT[FL_TRIANGLE_NODES] = {0.225,
                                                             0.13239415278850618074,
                                                             0.13239415278850618074,
                                                             0.13239415278850618074,
                                                             0.12593918054482715260,
                                                             0.12593918054482715260,
                                                             0.12593918054482715260};

/* Gauss-Legendre rules on [0, 1].  n points are exact for polynomials of degree 2 n - 1.  3 points: */
enum { FL_LINE3_NODES = 3 };
static const double FL_LINE3_NODE[FL_LINE3_NODES] = {0.11270166537925831148, 0.5, 0.88729833462074168852};
static const double FL_LINE3_WEIGHT[FL_LINE3_NODES] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};

/* 4 points. */
enum { FL_LINE4_NODES = 4 };
static const double FL_LINE4_NODE[FL_LINE4_NODES] = {0.06943184420297371239, 0.33000947820757186760,
                                                     0.66999052179242813240, 0.93056815579702628761};
static const double FL_LINE4_WEIGHT[FL_LINE4_NODES] = {0.17392742256872692869, 0.32607257743127307131,
                                                       0.32607257743127307131, 0.17392742256872692869};

/* 6 points. */
enum { FL_LINE_NODES = 6 };
static const double FL_LINE_NODE[FL_LINE_NODES] = {0.03376524289842398609, 0.16939530676686774317,
                                                   0.38069040695840154568, 0.61930959304159845432,
                                                   0.83060469323313225683, 0.96623475710157601391};
static const double FL_LINE_WEIGHT[FL_LINE_NODES] = {0.08566224618958517252, 0.18038078652406930378,
                                                     0.23395696728634552369, 0.23395696728634552369,
                                                     0.18038078652406930378, 0.08566224618958517252};

/* 10 points, padded with zeros to full SIMD registers. */
enum { FL_LINE10_NODES = 10, FL_LINE10_PADDED = 12 };
static const double FL_LINE10_NODE[FL_LINE10_PADDED] = {
    0.01304673574141413996, 0.06746831665550774463, 0.16029521585048779688, 0.28330230293537640460,
    0.42556283050918439456, 0.57443716949081560544, 0.71669769706462359540, 0.83970478414951220312,
    0.93253168334449225537, 0.98695326425858586004};
static const double FL_LINE10_WEIGHT[FL_LINE10_PADDED] = {
    0.03333567215434406880, 0.07472567457529029657, 0.10954318125799102200, 0.13463335965499817755,
    0.14776211235737643509, 0.14776211235737643509, 0.13463335965499817755, 0.10954318125799102200,
    0.07472567457529029657, 0.03333567215434406880};

#endif
