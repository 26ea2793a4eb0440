#ifndef SUN2XP_HANDLES_H
#define SUN2XP_HANDLES_H

#include <stddef.h>

/* The structs have the library's layout even after #pragma pack of the program. */
#if defined(__clang__) || defined(__GNUC__)
#pragma pack(push, 16)
#endif

/* Some calls have the name of their struct. -Wshadow of g++ warns that such a call hides a constructor. */
#if defined(__cplusplus) && defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* An open hand. The library never dereferences a handle, and refuses one that belongs to no open hand. */
typedef struct sun2xp_hand sun2xp_hand;
