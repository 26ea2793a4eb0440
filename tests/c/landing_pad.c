/* A library with the function call(), which holds a lock while it calls work(). If this file is compiled with
   -fexceptions, call() also releases the lock when work() unwinds the stack. The frame of call() then has a landing
   pad. */
void work(void);
void call(void);

static void release(int *lock)
{
    *lock = 0;
}

void call(void)
{
    int lock __attribute__((cleanup(release))) = 1;
    work();
}
