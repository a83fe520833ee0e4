// Work that is asked for more often than it can be done: the latest wish is next.

export class Latest {
  readonly #work: (wish: string) => Promise<void>;
  readonly #onFail: (error: unknown) => void;
  #wish: string | null = null;
  #done: string | null = null;
  #running: Promise<void> | null = null;

  /// `work`: done for one wish at a time. `onFail`: told why one could not be; that one is not tried again by itself.
  constructor(work: (wish: string) => Promise<void>, onFail: (error: unknown) => void) {
    this.#work = work;
    this.#onFail = onFail;
  }

  ask(wish: string): void {
    this.#wish = wish;
    if (wish !== this.#done) this.#running ??= this.#run();
  }

  /// Resolves once nothing is wished for that was not done.
  get rest(): Promise<void> {
    return this.#running ?? Promise.resolve();
  }

  /// Does nothing more.
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
