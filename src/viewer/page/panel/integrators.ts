/** The types of integrator of a scene. */
export const INTEGRATORS = [
  { value: 'explicit_euler', label: 'explicit Euler' },
  { value: 'symplectic_euler', label: 'symplectic Euler' },
  { value: 'verlet', label: 'Verlet' },
  { value: 'velocity_verlet', label: 'velocity Verlet' },
  { value: 'rk4', label: 'Runge-Kutta 4' },
  { value: 'implicit_euler', label: 'implicit Euler' },
] as const;

export function integratorLabel(type: string): string {
  return INTEGRATORS.find(({ value }) => value === type)?.label ?? type;
}
