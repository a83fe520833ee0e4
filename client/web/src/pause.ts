// Pauses in long work, in which the browser draws and answers the user.

/// Resolves in another task.
export function pause(): Promise<void> {
  return new Promise((resolve) => setTimeout(resolve));
}
