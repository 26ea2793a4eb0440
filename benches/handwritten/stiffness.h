/* The joint stiffness that the fingertip's stiffness requires, and the part of it that the tendons can carry. These
 * functions are in a header that only step.c includes, so the compiler sees the whole step in one translation unit. */
#include <math.h>

#include "structures.h"

static const double LEAST_LEVER = 0.5;

static double clamp(double value, double low, double high)
{
    return value < low ? low : value > high ? high : value;
}

/* Rows 0 to 2: the Jacobian of eq. 8. Rows 3 to 5: the axes of the joints. */
static void spatial_jacobian(const double links[JOINTS], const double joints[JOINTS], double j[TIP][JOINTS])
{
    double s0 = sin(joints[0]), c0 = cos(joints[0]);
    double s1 = sin(joints[1]), c1 = cos(joints[1]);
    double s2 = sin(joints[2]), c2 = cos(joints[2]);
    double s12 = c1 * s2 + s1 * c2, c12 = c1 * c2 - s1 * s2;
    double reach = links[0] + links[1] * c1 + links[2] * c12;
    double fall = -links[1] * s1 - links[2] * s12;
    j[0][0] = reach * c0;
    j[0][1] = fall * s0;
    j[0][2] = -links[2] * s12 * s0;
    j[1][0] = 0.0;
    j[1][1] = -links[1] * c1 - links[2] * c12;
    j[1][2] = -links[2] * c12;
    j[2][0] = -reach * s0;
    j[2][1] = fall * c0;
    j[2][2] = -links[2] * s12 * c0;
    j[3][0] = 0.0;
    j[3][1] = c0;
    j[3][2] = c0;
    j[4][0] = 1.0;
    j[4][1] = 0.0;
    j[4][2] = 0.0;
    j[5][0] = 0.0;
    j[5][1] = -s0;
    j[5][2] = -s0;
}

/* Eq. 6: J^T K J. */
static void joint_stiffness(const double k[TIP][TIP], const double j[TIP][JOINTS], double k_theta[JOINTS][JOINTS])
{
    double kj[TIP][JOINTS];
    for (int row = 0; row < TIP; row++)
        for (int column = 0; column < JOINTS; column++) {
            kj[row][column] = 0.0;
            for (int i = 0; i < TIP; i++)
                kj[row][column] += k[row][i] * j[i][column];
        }
    for (int row = 0; row < JOINTS; row++)
        for (int column = 0; column < JOINTS; column++) {
            k_theta[row][column] = 0.0;
            for (int i = 0; i < TIP; i++)
                k_theta[row][column] += j[i][row] * kj[i][column];
        }
}

static void multiply(const double a[JOINTS][JOINTS], const double b[JOINTS][JOINTS], double product[JOINTS][JOINTS])
{
    for (int row = 0; row < JOINTS; row++)
        for (int column = 0; column < JOINTS; column++)
            product[row][column] =
                a[row][0] * b[0][column] + a[row][1] * b[1][column] + a[row][2] * b[2][column];
}

/* The largest eigenvalue of a symmetric matrix, by the trigonometric formula. */
static double largest_eigenvalue(const double m[JOINTS][JOINTS])
{
    double square[JOINTS][JOINTS];
    multiply(m, m, square);
    double first = m[0][0] + m[1][1] + m[2][2];
    double second = 0.5 * (first * first - (square[0][0] + square[1][1] + square[2][2]));
    double third = first / 3.0;
    double spread = third * third - second / 3.0;
    double root = sqrt(spread > 0.0 ? spread : 0.0);
    if (root <= 1e-12 * fabs(third))
        return third;
    double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
        - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    double cubic = third * third * third - 0.5 * third * second + 0.5 * determinant;
    return third + 2.0 * root * cos(acos(clamp(cubic / (spread * root), -1.0, 1.0)) / 3.0);
}

/* When the tip is near the axis of joint 0, joint 0 needs more stiffness than J^T K J gives it. Returns the stiffness
 * to add. */
static double hold(const double k[TIP][TIP], const double j[TIP][JOINTS])
{
    double lacking = LEAST_LEVER * LEAST_LEVER - (j[0][0] * j[0][0] + j[1][0] * j[1][0] + j[2][0] * j[2][0]);
    if (lacking <= 0.0)
        return 0.0;
    double held = 0.0;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++)
            held += j[3 + row][1] * k[row][column] * j[3 + column][1];
    return held * lacking;
}

/* Returns the largest fraction of K_theta, at most 1, that the tendons can carry while the motors are locked. The
 * tendons carry the stiffness of the soft joint limits first, and K_theta gets what is left. */
static double admissible(const struct parameters *p, const double k_theta[JOINTS][JOINTS], const double limits[JOINTS])
{
    double half[JOINTS][JOINTS], transposed[JOINTS][JOINTS], whole[JOINTS][JOINTS];
    multiply(p->inverse_cholesky, k_theta, half);
    for (int row = 0; row < JOINTS; row++)
        for (int column = 0; column < JOINTS; column++)
            transposed[row][column] = p->inverse_cholesky[column][row];
    multiply(half, transposed, whole);
    double largest = largest_eigenvalue(whole);
    double left = p->share;
    for (int i = 0; i < JOINTS; i++)
        left -= limits[i] * p->compliance[i];
    return largest > left ? left / largest : 1.0;
}
