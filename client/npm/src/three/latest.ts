// Work that is requested more often than it can be done: only the latest request is kept.

export class Latest {
  readonly #work: (wish: string) => Promise<void>;
  readonly #onFail: (error: unknown) => void;
  #wish: string | null = null;
  #done: string | null = null;
  #running: Promise<void> | null = null;

  /// `work`: function that serves one request at a time. `onFail`: function called with an error; the request is not
  /// retried.
  constructor(work: (wish: string) => Promise<void>, onFail: (error: unknown) => void) {
    this.#work = work;
    this.#onFail = onFail;
  }

  ask(wish: string): void {
    this.#wish = wish;
    if (wish !== this.#done) this.#running ??= this.#run();
  }

  /// Resolves once no request is pending.
  get rest(): Promise<void> {
    return this.#running ?? Promise.resolve();
  }

  /// Drops the pending request, and serves no more.
  stop(): void {
    this.#wish = this.#done;
  }

  async #run(): Promise<void> {
    while (this.#wish !== this.#done) {
      const wish = this.#wish!;
      try {
        await this.#work(wish);
      } catch (error) {
        this.#onFail(error);
      }
      if (this.#wish !== this.#done) this.#done = wish;
    }
    this.#running = null;
  }
}
