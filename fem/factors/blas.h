#pragma once

/// The BLAS and LAPACK routines that are used, with their Fortran names.
extern "C" {
/// c = beta c + alpha op(a) op(b)
void dgemm_(const char* op_a, const char* op_b, const int* m, const int* n, const int* k,
            const double* alpha, const double* a, const int* a_stride, const double* b,
            const int* b_stride, const double* beta, double* c, const int* c_stride);
/// y = beta y + alpha op(a) x
void dgemv_(const char* op, const int* m, const int* n, const double* alpha, const double* a,
            const int* a_stride, const double* x, const int* x_step, const double* beta, double* y,
            const int* y_step);
/// b = alpha op(a)^-1 b or alpha b op(a)^-1, a triangular
void dtrsm_(const char* side, const char* triangle, const char* op, const char* diagonal,
            const int* m, const int* n, const double* alpha, const double* a, const int* a_stride,
            double* b, const int* b_stride);
/// x = op(a)^-1 x, a triangular
void dtrsv_(const char* triangle, const char* op, const char* diagonal, const int* n,
            const double* a, const int* a_stride, double* x, const int* x_step);
/// a = Cholesky factor of a; status 0: a is positive definite
void dpotrf_(const char* triangle, const int* n, double* a, const int* a_stride, int* status);
}
