/*
 * The handshake `robust` (src/protocol/handshake/README.md) once more, for SPIN: one master and N slaves in a star, every channel a register
 * that holds the last published word, calls and faults (loss, crash) from budgets, everybody switched on at the beginning.
 *
 *   spin -a -DN=2 -DCALLS=2 -DFAULTS=1 robust.pml && gcc -O2 -DSAFETY -DNOREDUCE -o pan pan.c && ./pan -m1000000
 *
 * Written from the rules, not from the code. Each action of takt's explorer is one d_step here, and nothing else is, so a state
 * of SPIN is a state of the explorer and both find the same number. What is different in form:
 *   - nobody restarts, so incarnations are left out, and a run is named by the number of the intent that opened it;
 *   - a message has no sequence number: in a register nothing is overtaken. Whether a peer was heard, and heard since its last
 *     silence, is kept, because the explorer keeps it.
 *   - the observer of S1, S2 and S4 keeps its facts in arrays by run instead of in a list.
 *
 * BREAK: 1 the master is Ready without asking the first slave; 2 silence is ignored; 3 intents are compared by number alone.
 */
#ifndef N
#define N 1
#endif
#ifndef CALLS
#define CALLS 2
#endif
#ifndef FAULTS
#define FAULTS 0
#endif
#ifndef BREAK
#define BREAK 0
#endif
#define P (N + 1)      /* participants: 0 the master */
#define C (2 * N)      /* channels: 0..N-1 to the master, N..2N-1 from it */
#define RUNS 20        /* runs are named by numbers of intents, which stay below */
#define EVERYBODY ((1 << P) - 1)

#define HALTED 0
#define READY 1
#define RUNNING 2
#define SUSPENDED 3
#define INIT 4
#define MISMATCH 9

#define START 0        /* kinds of intents, by precedence */
#define RESUME 1
#define SUSPEND 2
#define FINISH 3
#define RESET 4
#define HALT 5

/* participants */
byte state[P];
bool initialised[P];
byte in_run[P];
byte number[P];
byte kind[P] = HALT;
byte origin[P];
byte opened[P];        /* the run of the intent */
bool down[P];
/* what was heard last, by channel */
bool heard[C];
bool known[C];
byte heard_state[C];
byte heard_run[C];
/* registers; empty ones are all zero */
bool said[C];
byte w_state[C];
byte w_run[C];
byte w_number[C];
byte w_kind[C];
byte w_origin[C];
byte w_opened[C];
/* the observer */
byte was_ready[RUNS];
byte was_running[RUNS];
byte passed_init;
/* budgets */
byte calls = CALLS;
byte faults = FAULTS;

/* within a step only */
hidden byte target;
hidden byte old_state;
hidden byte old_run;
hidden byte top;
hidden byte through_halted;
hidden byte through_init;

#define SENDER(c) ((c) < N -> (c) + 1 : 0)
#define RECEIVER(c) ((c) < N -> 0 : (c) - N + 1)
/* the channel on which a slave, or the master, hears its only, or its k-th peer */
#define FROM_MASTER(i) (N + (i) - 1)

#define COUNTS_READY(c, i) (heard_state[c] == READY && heard_run[c] == opened[i])
#define COUNTS_RUNNING(c, i) (heard_state[c] == RUNNING && heard_run[c] == opened[i])
#if N == 1
#define FIRST_READY COUNTS_READY(0, 0)
#define OTHERS_READY true
#define ALL_RUNNING COUNTS_RUNNING(0, 0)
#elif N == 2
#define FIRST_READY COUNTS_READY(0, 0)
#define OTHERS_READY COUNTS_READY(1, 0)
#define ALL_RUNNING (COUNTS_RUNNING(0, 0) && COUNTS_RUNNING(1, 0))
#else
#define FIRST_READY COUNTS_READY(0, 0)
#define OTHERS_READY (COUNTS_READY(1, 0) && COUNTS_READY(2, 0))
#define ALL_RUNNING (COUNTS_RUNNING(0, 0) && COUNTS_RUNNING(1, 0) && COUNTS_RUNNING(2, 0))
#endif
#if BREAK == 1
#define ALL_READY OTHERS_READY
#else
#define ALL_READY (FIRST_READY && OTHERS_READY)
#endif

#define MAY_BE_READY ((state[0] == INIT && initialised[0]) || (state[0] == READY && in_run[0] != opened[0]))
#define MASTER_BARRIER (kind[0] == START && ((MAY_BE_READY && ALL_READY) || (state[0] == READY && in_run[0] == opened[0] && ALL_RUNNING)))
#define SLAVE_BARRIER(i) (kind[i] == START && state[i] == READY && in_run[i] == opened[i] && \
                          (COUNTS_READY(FROM_MASTER(i), i) || COUNTS_RUNNING(FROM_MASTER(i), i)))
#define BARRIER(i) ((i) == 0 && MASTER_BARRIER || (i) > 0 && SLAVE_BARRIER(i))

#if BREAK == 3
#define GREATER(c, i) (w_number[c] > number[i])
#else
#define GREATER(c, i) (w_number[c] > number[i] || w_number[c] == number[i] && (w_kind[c] > kind[i] || w_kind[c] == kind[i] && \
                       (w_origin[c] > origin[i] || w_origin[c] == origin[i] && w_opened[c] > opened[i])))
#endif
#define SAME_INTENT(c, i) (w_number[c] == number[i] && w_kind[c] == kind[i] && w_origin[c] == origin[i] && w_opened[c] == opened[i])
#define COUNTED_WITHOUT_ME(c, i) ((i) > 0 && w_kind[c] == START && (GREATER(c, i) || SAME_INTENT(c, i)) && w_run[c] == w_opened[c] && w_run[c] != in_run[i])

inline begin_step(i) {
  old_state = state[i]; old_run = in_run[i];
  through_halted = false; through_init = false
}

/* What the observer sees of a step. */
inline end_step(i) {
  if
  :: through_halted -> passed_init = passed_init & ~(1 << i)
  :: else
  fi;
  if
  :: through_init -> passed_init = passed_init | (1 << i)
  :: else
  fi;
  if
  :: state[i] == READY && (old_state != READY || old_run != in_run[i]) -> was_ready[in_run[i]] = was_ready[in_run[i]] | (1 << i)
  :: state[i] == RUNNING && old_state != RUNNING ->
     was_running[in_run[i]] = was_running[in_run[i]] | (1 << i);
     assert(was_ready[in_run[i]] == EVERYBODY);                       /* S1 */
     assert(i != 0 || was_running[in_run[i]] == EVERYBODY);           /* S2 */
     assert(passed_init & (1 << i))                                /* S4 */
  :: else
  fi;
  target = 0; old_state = 0; old_run = 0; top = 0; through_halted = false; through_init = false
}

/* To the state `target`. INIT is entered afresh, from Halted. */
inline move(i) {
  if
  :: target == INIT ->
     if
     :: state[i] != HALTED -> through_halted = true
     :: else
     fi;
     through_init = true; initialised[i] = false; in_run[i] = 0; state[i] = INIT
  :: target != INIT && target != state[i] ->
     if
     :: target == HALTED -> in_run[i] = 0; through_halted = true
     :: else
     fi;
     initialised[i] = false; state[i] = target
  :: else
  fi
}

/* A new intent of this kind, above the own one and `top`. */
inline raise(i, k) {
  if
  :: number[i] > top -> top = number[i]
  :: else
  fi;
  number[i] = top + 1; kind[i] = k; origin[i] = i;
  if
  :: k == START -> opened[i] = number[i]
  :: k == HALT -> opened[i] = 0
  :: else -> opened[i] = in_run[i]
  fi
}

inline alarm(i) { raise(i, HALT); target = HALTED; move(i) }

/* Where who is in state s goes by an intent of kind k. */
inline react(k, s) {
  if
  :: k == HALT -> target = HALTED
  :: k == START -> target = (s == READY -> READY : INIT)
  :: (k == RESET || k == FINISH) -> target = (s == HALTED || s == INIT -> MISMATCH : READY)
  :: k == SUSPEND -> target = (s == RUNNING || s == SUSPENDED -> SUSPENDED : MISMATCH)
  :: k == RESUME -> target = (s == RUNNING || s == SUSPENDED -> RUNNING : MISMATCH)
  fi
}

inline barrier(i) {
  if
  :: i == 0 && kind[0] == START && MAY_BE_READY && ALL_READY -> in_run[0] = opened[0]; target = READY; move(0)
  :: i == 0 && kind[0] == START && !(MAY_BE_READY && ALL_READY) && state[0] == READY && in_run[0] == opened[0] && ALL_RUNNING -> target = RUNNING; move(0)
  :: i > 0 && SLAVE_BARRIER(i) -> target = RUNNING; move(i)
  :: else
  fi
}

inline receive(c, i) {
  begin_step(i);
  heard[c] = true; known[c] = true; heard_state[c] = w_state[c]; heard_run[c] = w_run[c];
  top = w_number[c];
  if
  :: COUNTED_WITHOUT_ME(c, i) -> alarm(i)
  :: !COUNTED_WITHOUT_ME(c, i) && GREATER(c, i) ->
     react(w_kind[c], state[i]);
     if
     :: target == MISMATCH || (w_kind[c] != START && w_kind[c] != HALT && w_opened[c] != in_run[i]) || (i == 0 && w_kind[c] == START) -> alarm(i)
     :: else ->
        number[i] = w_number[c]; kind[i] = w_kind[c]; origin[i] = w_origin[c]; opened[i] = w_opened[c];
        if
        :: w_kind[c] == START && state[i] == READY -> in_run[i] = w_opened[c]
        :: else
        fi;
        move(i)
     fi
  :: else
  fi;
  barrier(i);
  end_step(i)
}

#define WORD_IS_NEWS(c, i) (!heard[c] || !known[c] || heard_state[c] != w_state[c] || heard_run[c] != w_run[c] || COUNTED_WITHOUT_ME(c, i) || GREATER(c, i) || BARRIER(i))

inline clear(c) { said[c] = false; w_state[c] = 0; w_run[c] = 0; w_number[c] = 0; w_kind[c] = 0; w_origin[c] = 0; w_opened[c] = 0 }

inline forget(c) { heard[c] = false; known[c] = false; heard_state[c] = 0; heard_run[c] = 0 }

#define IS_PUBLISHED(c, i) (said[c] && w_state[c] == state[i] && w_run[c] == in_run[i] && w_number[c] == number[i] && w_kind[c] == kind[i] && \
                            w_origin[c] == origin[i] && w_opened[c] == opened[i])

#define CAN_SEND(c) (!down[SENDER(c)] && !IS_PUBLISHED(c, SENDER(c)))
#define CAN_HEAR(c) (said[c] && !down[RECEIVER(c)] && WORD_IS_NEWS(c, RECEIVER(c)))
#define CAN_MISS(c) (down[SENDER(c)] && !down[RECEIVER(c)] && (known[c] || said[c] || (state[RECEIVER(c)] != HALTED && NOTICES)))
#define CAN_INITIALISE(i) (state[i] == INIT && !down[i] && !initialised[i])
#define CAN_CHANGE(c) (CAN_SEND(c) || CAN_HEAR(c) || CAN_MISS(c) || CAN_INITIALISE(SENDER(c)))

#define CHANNEL(c) \
  :: d_step { CAN_SEND(c) -> said[c] = true; w_state[c] = state[SENDER(c)]; w_run[c] = in_run[SENDER(c)]; \
              w_number[c] = number[SENDER(c)]; w_kind[c] = kind[SENDER(c)]; w_origin[c] = origin[SENDER(c)]; w_opened[c] = opened[SENDER(c)] } \
  :: d_step { CAN_HEAR(c) -> receive(c, RECEIVER(c)) } \
  :: d_step { faults > 0 && said[c] -> clear(c); faults-- } \
  :: d_step { CAN_MISS(c) -> \
              begin_step(RECEIVER(c)); known[c] = false; top = 0; \
              if \
              :: state[RECEIVER(c)] != HALTED && NOTICES -> alarm(RECEIVER(c)) \
              :: else \
              fi; \
              clear(c); end_step(RECEIVER(c)) }

#if BREAK == 2
#define NOTICES false
#else
#define NOTICES true
#endif

inline command(i, k) { begin_step(i); top = 0; react(k, state[i]); old_run = in_run[i]; raise(i, k); move(i); end_step(i); calls-- }

#define UP(i) (calls > 0 && !down[i])
#define SAW_MASTER_RUN(i) ((i) == 0 || heard_run[FROM_MASTER(i)] == in_run[i] && (heard_state[FROM_MASTER(i)] == RUNNING || heard_state[FROM_MASTER(i)] == SUSPENDED))

#define PARTICIPANT(i) \
  :: d_step { UP(i) && state[i] != HALTED -> command(i, HALT) } \
  :: d_step { UP(i) && state[i] == RUNNING -> command(i, FINISH) } \
  :: d_step { UP(i) && state[i] == SUSPENDED -> command(i, RESUME) } \
  :: d_step { UP(i) && state[i] == SUSPENDED -> command(i, RESET) }

#define SLAVE(i) \
  PARTICIPANT(i) \
  :: d_step { UP(i) && state[i] == RUNNING && SAW_MASTER_RUN(i) -> command(i, SUSPEND) } \
  :: d_step { CAN_INITIALISE(i) -> begin_step(i); in_run[i] = opened[i]; target = READY; move(i); end_step(i) } \
  :: d_step { faults > 0 && !down[i] -> crash(i); forget(FROM_MASTER(i)); faults-- }

inline crash(i) {
  down[i] = true; state[i] = 0; initialised[i] = false; in_run[i] = 0; number[i] = 0; kind[i] = 0; origin[i] = 0; opened[i] = 0
}

#if N == 1
#define SAME(i) (state[1] == state[0] && number[1] == number[0] && kind[1] == kind[0] && origin[1] == origin[0] && opened[1] == opened[0])
#define ALL_SAME SAME(1)
#define SOMEBODY_DOWN (down[0] || down[1])
#define OTHERS_HALTED ((down[0] || state[0] == HALTED) && (down[1] || state[1] == HALTED))
#else
#define SAME(i) (state[i] == state[0] && number[i] == number[0] && kind[i] == kind[0] && origin[i] == origin[0] && opened[i] == opened[0])
#define ALL_SAME (SAME(1) && SAME(2))
#define SOMEBODY_DOWN (down[0] || down[1] || down[2])
#define OTHERS_HALTED ((down[0] || state[0] == HALTED) && (down[1] || state[1] == HALTED) && (down[2] || state[2] == HALTED))
#endif
#define GOAL(k) ((k) == HALT -> HALTED : ((k) == RESET || (k) == FINISH -> READY : ((k) == SUSPEND -> SUSPENDED : RUNNING)))
#define SETTLED (SOMEBODY_DOWN && OTHERS_HALTED || !SOMEBODY_DOWN && ALL_SAME && state[0] == GOAL(kind[0]))

/* Nothing changes any more without calls and faults. */
#if N == 1
#define QUIET (!CAN_CHANGE(0) && !CAN_CHANGE(1))
#else
#define QUIET (!CAN_CHANGE(0) && !CAN_CHANGE(1) && !CAN_CHANGE(2) && !CAN_CHANGE(3))
#endif

active proctype group() {
  do
  CHANNEL(0)
  CHANNEL(1)
#if N == 2
  CHANNEL(2)
  CHANNEL(3)
#endif
  PARTICIPANT(0)
  :: d_step { UP(0) && (state[0] == HALTED || state[0] == READY && (kind[0] == RESET || kind[0] == FINISH)) -> command(0, START) }
  :: d_step { UP(0) && state[0] == RUNNING -> command(0, SUSPEND) }
  :: d_step { CAN_INITIALISE(0) -> begin_step(0); initialised[0] = true; barrier(0); end_step(0) }
#if N == 1
  :: d_step { faults > 0 && !down[0] -> crash(0); forget(0); faults-- }
#else
  :: d_step { faults > 0 && !down[0] -> crash(0); forget(0); forget(1); faults-- }
#endif
  SLAVE(1)
#if N == 2
  SLAVE(2)
#endif
#ifndef CYCLES
  :: d_step { QUIET -> assert(SETTLED) }  /* L1 and F1 */
#endif
  od
}
