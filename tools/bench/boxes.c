// Steps per second of CPU time of a box-pushing puzzle written in C: what a program that knows one game reaches.
//
// cc -O3 -march=native boxes.c -o boxes && ./boxes 4096 640
//
// 4,096 boards of 10 x 10 cells and four boxes are stepped one after the other on one thread. Each step writes four planes of bytes
// (walls, goals, boxes, player; only what changes), a reward and a flag. An episode ends when all boxes are on goals, or after 120
// steps, and the board starts anew.
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { SIDE = 10, CELLS = SIDE * SIDE, PLANES = 4, LIMIT = 120 };
enum { WALL, GOAL, BOX, PLAYER };

static const char *LEVEL = "##########"
                           "#   ##   #"
                           "# .  $ . #"
                           "#  $   # #"
                           "## ###   #"
                           "#    #  ##"
                           "# $  @ . #"
                           "#  #  $  #"
                           "#  . #   #"
                           "##########";

typedef struct {
    int32_t player, off, steps;
} Board;

static void start(Board *board, uint8_t *planes, const uint8_t *first, Board at) {
    memcpy(planes, first, PLANES * CELLS);
    *board = at;
}

int main(int argc, char **argv) {
    const size_t count = argc > 1 ? strtoul(argv[1], NULL, 10) : 4096, ticks = argc > 2 ? strtoul(argv[2], NULL, 10) : 640;
    // Nothing, up, left, down, right.
    static const int moves[5] = {0, -SIDE, -1, SIDE, 1};
    uint8_t first[PLANES * CELLS] = {0};
    Board at = {0};
    for (int cell = 0; cell < CELLS; cell++) {
        const char mark = LEVEL[cell];
        first[WALL * CELLS + cell] = mark == '#';
        first[GOAL * CELLS + cell] = mark == '.';
        first[BOX * CELLS + cell] = mark == '$';
        first[PLAYER * CELLS + cell] = mark == '@';
        at.off += mark == '$';
        at.player = mark == '@' ? cell : at.player;
    }
    Board *boards = malloc(count * sizeof *boards);
    uint8_t *observed = malloc(count * PLANES * CELLS), *over = malloc(count), *actions = malloc(16 * count);
    float *rewards = malloc(count * sizeof *rewards);
    if (!boards || !observed || !over || !actions || !rewards) return 3;
    for (size_t env = 0; env < count; env++) start(&boards[env], observed + env * PLANES * CELLS, first, at);
    uint64_t random = 0x9e3779b97f4a7c15;
    for (size_t at = 0; at < 16 * count; at++) {
        random ^= random << 13, random ^= random >> 7, random ^= random << 17;
        actions[at] = (random >> 32) % 5;
    }
    double sum = 0;
    const clock_t began = clock();
    for (size_t tick = 0; tick < ticks; tick++) {
        for (size_t env = 0; env < count; env++) {
            Board *board = &boards[env];
            uint8_t *planes = observed + env * PLANES * CELLS;
            uint8_t *walls = planes + WALL * CELLS, *goals = planes + GOAL * CELLS, *boxes = planes + BOX * CELLS;
            const int move = moves[actions[tick % 16 * count + env]], to = board->player + move, beyond = to + move;
            float reward = 0;
            const int pushes = boxes[to];
            if (move && !walls[to] && !(pushes && (walls[beyond] || boxes[beyond]))) {
                if (pushes) {
                    boxes[to] = 0, boxes[beyond] = 1;
                    const int change = goals[beyond] - goals[to];
                    board->off -= change;
                    reward = change;
                }
                planes[PLAYER * CELLS + board->player] = 0, planes[PLAYER * CELLS + to] = 1;
                board->player = to;
            }
            const int is_over = ++board->steps == LIMIT || board->off == 0;
            rewards[env] = reward, over[env] = is_over;
            if (is_over) start(board, planes, first, at);
        }
        sum += rewards[tick % count];
    }
    const double seconds = (double)(clock() - began) / CLOCKS_PER_SEC;
    printf("%.0f\n", count * ticks / seconds);
    // Keeps the work from being left out.
    return sum > 1e9;
}
