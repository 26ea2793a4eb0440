#ifndef SUN2XP_H
#define SUN2XP_H

#ifdef SUN2XP_REAL
/* The value of SUN2XP_REAL as a number: 1 for float, 2 for double, 0 for anything else. */
#define SUN2XP_REAL_IS_float 1
#define SUN2XP_REAL_IS_double 2
#define SUN2XP_PASTE_NOW(Left, Right) Left##Right
#define SUN2XP_PASTE(Left, Right) SUN2XP_PASTE_NOW(Left, Right)
#if SUN2XP_PASTE(SUN2XP_REAL_IS_, SUN2XP_REAL) == 2
#define SUN2XP_REAL_DOUBLE
#elif SUN2XP_PASTE(SUN2XP_REAL_IS_, SUN2XP_REAL) != 1
#error "SUN2XP_REAL must be float or double: compile with -DSUN2XP_REAL=float or -DSUN2XP_REAL=double"
#endif
#endif

@SHIELD@
#ifdef __cplusplus
extern "C" {
#endif
