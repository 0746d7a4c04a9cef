import type { Command, Frame, Header, TextMessage, Topology } from './protocol';

export interface SourceListener {
  connected(connected: boolean): void;
  /** The server cannot be reached, or refuses the token of the address. */
  lost(refused: boolean): void;
  text(message: TextMessage): void;
  topology(header: Header, topology: Topology): void;
  frame(header: Header, frame: Frame): void;
}

/** Where runs come from: a server, or the page itself. */
export interface Source {
  start(listener: SourceListener): void;
  send(command: Command): void;
}
