/* A planner of 1990: no header of the library, no prototypes, implicit int, and results that are ignored. */
#include <stdio.h>

#ifndef REAL
#define REAL float
#endif

REAL Pos[3] = {0.1, 0.5, 0.9};
REAL Kx[3][3] = {{3.0, 0.0, 0.0}, {0.0, 3.0, 0.0}, {0.0, 0.0, 3.0}};

far(sent, is)
REAL *sent, *is;
{
  int joint;
  for (joint = 0; joint < 3; joint++)
    if (sent[joint] - is[joint] > 0.02 || is[joint] - sent[joint] > 0.02)
      return 1;
  return 0;
}

main( )
{
  REAL Now[3];
  int i, arrived;

  OpenHand( );
  for (i = 1; i <= 3; i++) {
    SendKx(i, Kx);
    SendPos(i, Pos);
  }
  sleep(4);
  arrived = 0;
  for (i = 1; i <= 3; i++) {
    GetPos(i, Now);
    printf("finger %d: %f %f %f\n", i, Now[0], Now[1], Now[2]);
    if (!far(Pos, Now))
      arrived++;
  }
  CloseHand( );
  exit(arrived == 3 ? 0 : 1);
}
