/* A library with the function call(), which holds a lock while it calls work(). If work() unwinds the stack, call()
   releases the lock. So the frame of call() has a landing pad if this file is compiled with -fexceptions. */
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
