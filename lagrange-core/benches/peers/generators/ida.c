/* IDA of SUNDIALS on the equations and the Jacobian of our library, as the implicit y' − f(t, y) = 0; dense matrices.
 *
 * ida LIBRARY SYSTEM TOLERANCE TIME START ENDS
 *
 * Each line on the standard input asks for one run, which answers with what it took as a line of JSON; at its end the last state is
 * written to ENDS. The package scikit-sundae has the libraries of SUNDIALS 7 without headers: what is used of them is declared here. */
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef void *Context, *Vector, *Matrix, *Solver, *Memory;
typedef int Residual(double, Vector, Vector, Vector, void *);
typedef int Jacobian(double, double, Vector, Vector, Vector, Matrix, void *, Vector, Vector, Vector);
int SUNContext_Create(int communicator, Context *);
Vector N_VNew_Serial(long, Context);
double *N_VGetArrayPointer(Vector);
Matrix SUNDenseMatrix(long, long, Context);
double *SUNDenseMatrix_Column(Matrix, long);
Solver SUNLinSol_Dense(Vector, Matrix, Context);
Memory IDACreate(Context);
int IDAInit(Memory, Residual *, double, Vector, Vector);
int IDASStolerances(Memory, double, double);
int IDASetMaxNumSteps(Memory, long);
int IDASetLinearSolver(Memory, Solver, Matrix);
int IDASetJacFn(Memory, Jacobian *);
int IDASetStopTime(Memory, double);
int IDASolve(Memory, double, double *, Vector, Vector, int task);
int IDAGetNumSteps(Memory, long *);
int IDAGetNumErrTestFails(Memory, long *);
int IDAGetNumStepSolveFails(Memory, long *);
int IDAGetNumResEvals(Memory, long *);
void IDAFree(Memory *);

static int n;
static void (*rates)(double, const double *, double *), (*jacobian)(double, const double *, double *);

static int residual(double t, Vector y, Vector slope, Vector out, void *unused) {
    double *r = N_VGetArrayPointer(out), *s = N_VGetArrayPointer(slope);
    rates(t, N_VGetArrayPointer(y), r);
    for (int i = 0; i < n; i++) {
        r[i] = s[i] - r[i];
    }
    return 0;
}

static int by_state(double t, double c, Vector y, Vector slope, Vector r, Matrix out, void *unused, Vector a, Vector b, Vector d) {
    double by_row[n * n];
    jacobian(t, N_VGetArrayPointer(y), by_row);
    for (int j = 0; j < n; j++) {
        double *column = SUNDenseMatrix_Column(out, j);
        for (int i = 0; i < n; i++) {
            column[i] = (i == j ? c : 0.0) - by_row[n * i + j];
        }
    }
    return 0;
}

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

int main(int count, char **given) {
    char name[100], line[100];
    double tolerance = atof(given[3]), end = atof(given[4]), start[100], t;
    void *library = dlopen(given[1], RTLD_NOW);
    snprintf(name, sizeof name, "%s_rates", given[2]);
    *(void **)&rates = dlsym(library, name);
    snprintf(name, sizeof name, "%s_jacobian", given[2]);
    *(void **)&jacobian = dlsym(library, name);
    FILE *file = fopen(given[5], "rb");
    n = fread(start, sizeof(double), 100, file);
    Context context;
    SUNContext_Create(0, &context);
    Vector y = N_VNew_Serial(n, context), slope = N_VNew_Serial(n, context);
    Matrix matrix = SUNDenseMatrix(n, n, context);
    Solver solver = SUNLinSol_Dense(y, matrix, context);
    while (fgets(line, sizeof line, stdin)) {
        double begun = now();
        memcpy(N_VGetArrayPointer(y), start, n * sizeof(double));
        rates(0.0, start, N_VGetArrayPointer(slope));
        Memory ida = IDACreate(context);
        IDAInit(ida, residual, 0.0, y, slope);
        IDASStolerances(ida, tolerance, tolerance);
        IDASetMaxNumSteps(ida, 10000000);
        IDASetLinearSolver(ida, solver, matrix);
        IDASetJacFn(ida, by_state);
        IDASetStopTime(ida, end);
        int flag = IDASolve(ida, end, &t, y, slope, 1);
        if (flag < 0) {
            fprintf(stderr, "IDASolve returns %d at %g\n", flag, t);
            return 1;
        }
        double seconds = now() - begun;
        long steps, rejected, unsolved, evaluations;
        IDAGetNumSteps(ida, &steps);
        IDAGetNumErrTestFails(ida, &rejected);
        IDAGetNumStepSolveFails(ida, &unsolved);
        IDAGetNumResEvals(ida, &evaluations);
        printf("{\"seconds\": %.9g, \"steps\": %ld, \"rejected\": %ld, \"evaluations\": %ld}\n", seconds, steps,
               rejected + unsolved, evaluations);
        fflush(stdout);
        IDAFree(&ida);
    }
    file = fopen(given[6], "wb");
    fwrite(N_VGetArrayPointer(y), sizeof(double), n, file);
    return fclose(file);
}
